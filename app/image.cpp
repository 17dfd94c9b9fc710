#include "app/image.h"

#include "sim/error.h"
#include "sim/hairstyle.h"

// Debian's libstb is a library: the headers declare, it defines.
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

#include <algorithm>
#include <unistd.h>

namespace coif
{

static void append(void* to, void* data, int size)
{
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), size_t(size));
}

void save_png(const std::filesystem::path& file, const Image& image)
{
    std::string bytes;
    if (!stbi_write_png_to_func(append, &bytes, image.width, image.height, 4, image.pixels.data(), 4 * image.width))
        throw fail("{}: the picture could not be encoded", file.string());
    write_file(file, bytes);
}

Image load_png(const std::filesystem::path& file)
{
    const std::string bytes = read_file(file, 1 << 28);
    Image image;
    int channels = 0;
    unsigned char* pixels = stbi_load_from_memory(reinterpret_cast<const unsigned char*>(bytes.data()),
                                                  int(bytes.size()), &image.width, &image.height, &channels, 4);
    if (!pixels)
        throw fail("{}: is no picture that coif can read: {}", file.string(), stbi_failure_reason());
    image.pixels.assign(pixels, pixels + size_t(4) * size_t(image.width) * size_t(image.height));
    stbi_image_free(pixels);
    return image;
}

void save_hdr(const std::filesystem::path& file, const LinearImage& linear, float gain)
{
    constexpr float kMost = 1e37f; // that the format's exponent holds
    std::vector<float> light;
    light.reserve(linear.pixels.size() / 4 * 3);
    for (size_t i = 0; i + 3 < linear.pixels.size(); i += 4)
        for (size_t c = 0; c < 3; ++c)
        {
            const float l = gain * linear.pixels[i + c];
            light.push_back(l > 0.0f ? std::min(l, kMost) : 0.0f); // what is no number is black
        }
    std::string bytes;
    if (!stbi_write_hdr_to_func(append, &bytes, linear.width, linear.height, 3, light.data()))
        throw fail("{}: the picture could not be encoded", file.string());
    write_file(file, bytes);
}

void check_folder(const std::filesystem::path& file)
{
    std::error_code error;
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (std::filesystem::is_fifo(file, error) || std::filesystem::is_character_file(file, error))
        return; // /dev/stdout: its folder is none of ours
    if (std::filesystem::is_directory(file, error))
        throw fail("{}: is a folder; name a file in it", file.string());
    if (!std::filesystem::is_directory(folder, error) || access(folder.c_str(), W_OK) != 0)
        throw fail("{}: cannot be written; is its folder there, and writable?", file.string());
}

Image shrunk(const Image& image, int by)
{
    Image small{image.width / by, image.height / by, {}};
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x)
            for (int c = 0; c < 4; ++c)
            {
                int sum = 0;
                for (int j = 0; j < by; ++j)
                    for (int i = 0; i < by; ++i)
                        sum +=
                            image.pixels[size_t(4) * (size_t(y * by + j) * size_t(image.width) + size_t(x * by + i)) +
                                         size_t(c)];
                small.pixels.push_back(static_cast<unsigned char>(sum / (by * by)));
            }
    return small;
}

} // namespace coif
