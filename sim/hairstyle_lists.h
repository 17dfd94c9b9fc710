// The [[tables]] of a hairstyle file (sim/lists.h), read and written. What sim/hairstyle.cpp and hairstyle_save.cpp
// share.
#pragma once
#include "sim/hairstyle.h"
#include "sim/toml_edit.h"

#include <toml++/toml.h>

namespace coif
{

// Into `style` what a value in the file says of a parameter. Throws Error without a place.
void read_value(Hairstyle& style, const ParamInfo& info, const toml::node& node);

// Into `style` what the file says of a LIST; of each entry the place is kept, as "region[1]". Throws Error with the
// place for what is no such list, too long, or wrong in itself; what hangs on the scalp is check_lists()'s.
void read_list(Hairstyle& style, const ParamInfo& info, const toml::node& node);

// What the style's files beside it hold: strand shapes, and the values of large maps. Throws Error with the place.
void load_beside(Hairstyle& style);

// [sky] of a file of lights. Throws Error with the place.
Sky read_sky(const std::filesystem::path& file, const toml::node& node);
TomlEntry sky_entry(const Sky& sky);

// Entries as they are to be written: what differs from the defaults.
std::vector<TomlEntry> list_entries(const HostParams& host, const ParamInfo& info);

// [variant.NAME] tables. Throws Error with the place.
void read_variants(Hairstyle& style, const toml::node& node);

// A value of one parameter among others: of a region, of a variant. Throws Error with the place.
Setting read_setting(const std::filesystem::path& file, const std::string& path, const toml::key& key,
                     const toml::node& node);
std::string setting_text(const Setting& setting);
// Settings as keys: one inline table for each group of parameters.
TomlEntry settings_entry(const std::vector<Setting>& settings);

// A file of map values or weights: numbers within bounds, with white space between them. Throws Error for anything
// else.
std::vector<float> read_map_values(const std::filesystem::path& file, Limits bounds);
std::string map_values_text(const std::vector<float>& values);
constexpr size_t kMostInline = 4096; // values of a map or region that are kept in the hairstyle file itself

} // namespace coif
