#pragma once
#include "sim/hairstyle.h"

#include <string>
#include <vector>

namespace coif
{

// `coif import`, and what the editor does with a file of hair that is dropped onto it.
struct ImportOptions
{
    std::string up;    // a choice of groom.import_up; empty: by the file
    double scale = 0;  // m, groom.import_scale; 0: by the file
    std::string scalp; // scalp.mesh; empty: the default
    std::vector<std::string> sets;
};

// Has this file a suffix of hair that groom.import takes?
bool is_hair_file(const std::filesystem::path& file);

// A new style, to be saved as `target`, that shows the file's hair: in its colours, moved to the scalp if need be. What
// came of it is told in `report`, in lines. Throws Error as read_hair_file() and place_hair().
Hairstyle imported_style(const std::filesystem::path& file, const std::filesystem::path& target,
                         const ImportOptions& options, std::string& report);

} // namespace coif
