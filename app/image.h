#pragma once
#include <filesystem>
#include <vector>

namespace coif
{

// 8-bit sRGB with plain alpha, top row first.
struct Image
{
    int width = 0, height = 0;
    std::vector<unsigned char> pixels; // 4 a pixel
};

// Both throw Error. A picture is written beside its place and renamed into it.
void save_png(const std::filesystem::path& file, const Image& image);
Image load_png(const std::filesystem::path& file);

// Throws Error unless a file of that name could be written; for asking before long work.
void check_folder(const std::filesystem::path& file);

// Each pixel the mean of a block of `by` x `by`; what does not fill a block is left out.
Image shrunk(const Image& image, int by);

} // namespace coif
