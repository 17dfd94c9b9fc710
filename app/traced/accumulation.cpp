#include "app/traced/accumulation.h"

#include "sim/error.h"
#include "sim/hairstyle.h"

#include <cstring>

namespace coif
{

namespace fs = std::filesystem;

// The machine's own numbers follow: such a file stays where it was made. Width, height, two words of hash, the samples
// of each row, the sums.
static constexpr std::string_view kFirst = "coif traced 1\n";
static constexpr size_t kHead = 2 * sizeof(int32_t) + 2 * sizeof(uint64_t);

fs::path record_of(const fs::path& picture) { return fs::path(picture).replace_extension(".traced"); }

std::optional<Record> read_record(const fs::path& file)
{
    std::error_code error;
    if (!fs::exists(file, error))
        return std::nullopt;
    const std::string bytes = read_file(file, size_t(1) << 31);
    if (!bytes.starts_with(kFirst) || bytes.size() < kFirst.size() + kHead)
        throw fail("{}: is where a traced still keeps its samples, but no such file; move it away, or call the picture "
                   "otherwise",
                   file.string());
    const char* from = bytes.data() + kFirst.size();
    const auto take = [&](void* to, size_t size)
    {
        memcpy(to, from, size);
        from += size;
    };
    int32_t width = 0, height = 0;
    Record record;
    take(&width, sizeof width);
    take(&height, sizeof height);
    take(record.of.word, sizeof record.of.word);
    const size_t rows = size_t(std::max(height, 0)), pixels = rows * size_t(std::max(width, 0));
    if (width < 1 || height < 1 || width > 8192 || height > 8192 ||
        bytes.size() != kFirst.size() + kHead + rows * sizeof(uint32_t) + pixels * sizeof(glm::vec4))
        throw fail("{}: is a damaged record of a traced still; remove it to start anew", file.string());
    record.picture = empty_accumulation(width, height);
    take(record.picture.samples.data(), rows * sizeof(uint32_t));
    take(record.picture.sum.data(), pixels * sizeof(glm::vec4));
    return record;
}

void write_record(const fs::path& file, const Hash& of, const Accumulation& picture)
{
    std::string bytes(kFirst);
    bytes.reserve(bytes.size() + kHead + picture.samples.size() * sizeof(uint32_t) +
                  picture.sum.size() * sizeof(glm::vec4));
    const auto add = [&](const void* data, size_t size) { bytes.append(static_cast<const char*>(data), size); };
    const int32_t size[2] = {picture.width, picture.height};
    add(size, sizeof size);
    add(of.word, sizeof of.word);
    add(picture.samples.data(), picture.samples.size() * sizeof(uint32_t));
    add(picture.sum.data(), picture.sum.size() * sizeof(glm::vec4));
    write_file(file, bytes);
}

LinearImage mean_of(const Accumulation& picture)
{
    LinearImage image{picture.width, picture.height, {}};
    image.pixels.reserve(4 * picture.sum.size());
    for (size_t i = 0; i < picture.sum.size(); ++i)
    {
        const uint32_t samples = picture.samples[i / size_t(picture.width)];
        const glm::vec4 mean = picture.sum[i] / float(std::max(samples, 1u));
        image.pixels.insert(image.pixels.end(), {mean.x, mean.y, mean.z, mean.w});
    }
    return image;
}

} // namespace coif
