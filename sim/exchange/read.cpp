#include "sim/exchange/read.h"

#include "sim/error.h"
#include "sim/hairstyle.h"
#include "sim/shown.h"

#include <algorithm>

namespace coif
{

HairFile read_hair_file(const std::filesystem::path& file)
{
    return parse_hair_file(read_file(file), shown_file(file), file.extension().string());
}

HairFile parse_hair_file(std::string_view bytes, const std::string& name, std::string suffix)
{
    std::ranges::transform(suffix, suffix.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    HairFile file;
    if (bytes.starts_with("\x89HDF"))
        throw fail("{}: is Alembic of the old HDF5 kind; export it again as Ogawa, or turn it with: abcconvert "
                   "-toOgawa {} new.abc",
                   name, name);
    if (bytes.starts_with("PXR-USDC"))
        throw fail("{}: is USD's binary form; write its text form, which coif reads: usdcat {} -o new.usda", name,
                   name);
    if (suffix == ".usdz" || bytes.starts_with("PK\3\4"))
        throw fail("{}: is a packed archive of USD; unpack it with unzip, and write its text form, which coif reads: "
                   "usdcat FILE.usdc -o new.usda",
                   name);
    if (bytes.starts_with("Ogawa"))
        file = read_abc(bytes, name);
    else if (bytes.starts_with("HAIR"))
        file = read_hair(bytes, name);
    else if (bytes.starts_with("#usda"))
        file = read_usda(bytes, name);
    else if (suffix == ".tfx")
        file = read_tfx(bytes, name);
    else if (suffix == ".data")
        file = read_data(bytes, name);
    else
        throw fail("{}: is no file of hair that coif reads: Alembic (.abc), .hair, USD text (.usda), TressFX (.tfx) or "
                   ".data",
                   name);
    drop_bad_strands(file);
    if (file.curves.count.empty())
    {
        std::string why;
        for (const std::string& remark : file.remark)
            why += "; " + remark;
        throw fail("{}: holds no strands of hair{}: export its curves", name, why);
    }
    return file;
}

} // namespace coif
