#include "sim/source.h"

#include "sim/error.h"
#include "sim/hairstyle.h"

#include <cstdlib>
#include <set>
#include <sstream>

namespace coif
{

namespace fs = std::filesystem;

namespace
{
struct Expander
{
    fs::path other;
    std::string params_text;
    bool names_in_line_marks; // GLSL 1.50 takes numbers only
    std::set<fs::path> seen = {};

    std::string mark(const fs::path& file, int line) const
    {
        return names_in_line_marks ? fmt::format("#line {} \"{}\"\n", line, file.filename().string())
                                   : fmt::format("#line {}\n", line);
    }

    std::string expand(const fs::path& file)
    {
        std::istringstream in(read_file(file, 1 << 20));
        std::string text, line;
        for (int number = 1; std::getline(in, line); ++number)
        {
            if (line.rfind("#include \"", 0) != 0)
            {
                text += line + "\n";
                continue;
            }
            const std::string name = line.substr(10, line.find('"', 10) - 10);
            fs::path included = file.parent_path() / name;
            if (!fs::exists(included))
                included = other / name;
            if (name == "params" && !params_text.empty())
                text += params_text;
            else if (included.extension() == ".def" || seen.insert(fs::weakly_canonical(included)).second)
                text += mark(included, 1) + expand(included);
            text += mark(file, number + 1);
        }
        return text;
    }
};
} // namespace

std::string load_source(const fs::path& file, const fs::path& other, const std::string& params_text)
{
    Expander expander{other, params_text, file.extension() == ".cl"};
    return expander.expand(file);
}

const fs::path& data_folder()
{
    static const fs::path folder = []
    {
        std::error_code error;
        const fs::path program = fs::read_symlink("/proc/self/exe", error);
        std::vector<fs::path> candidates;
        if (const char* wish = std::getenv("COIF_DATA"))
            candidates.push_back(wish);
        candidates.push_back(program.parent_path().parent_path());
        candidates.push_back(program.parent_path().parent_path() / "share" / "coif");
        candidates.push_back(COIF_SOURCE_FOLDER);
        for (const fs::path& candidate : candidates)
            if (fs::exists(candidate / "kernels" / "params.def", error))
                return candidate;
        throw fail("coif's kernels/, shaders/ and assets/ are not beside {}; set COIF_DATA to the folder that holds "
                   "them",
                   program.string());
    }();
    return folder;
}

} // namespace coif
