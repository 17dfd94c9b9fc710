#pragma once
#include "kernels/shared.h"

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

// Light as the scene sends it, before exposure: linear sRGB, red, green, blue and alpha, premultiplied, top row first.
struct LinearImage
{
    int width = 0, height = 0;
    std::vector<float> pixels; // 4 a pixel
};

// By exposure and display transform of the style, as authored (app/display.h).
Image displayed(const LinearImage& linear, const HairParams& params);

// All throw Error. A picture is written beside its place and renamed into it.
void save_png(const std::filesystem::path& file, const Image& image);
Image load_png(const std::filesystem::path& file);
// Radiance RGBE, which has no alpha: what is transparent lies over black. Light is multiplied by `gain`, the exposure.
void save_hdr(const std::filesystem::path& file, const LinearImage& linear, float gain = 1.0f);

// Throws Error unless a file of that name could be written; for asking before long work.
void check_folder(const std::filesystem::path& file);

// Each pixel the mean of a block of `by` x `by`; what does not fill a block is left out.
Image shrunk(const Image& image, int by);

} // namespace coif
