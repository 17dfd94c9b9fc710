#pragma once
#include "app/image.h"

#include <vector>

namespace coif
{

// A share of all pixels, one entry each: those that count.
using Mask = std::vector<bool>;

// Structural similarity of two pictures of the same size (Wang, Bovik, Sheikh, Simoncelli. Image quality assessment:
// from error visibility to structural similarity. IEEE TIP 13(4), 2004): 1 for the same picture, about 0 for unrelated
// ones. Windows of 11 x 11 pixels weighted by a Gaussian of 1.5 pixels, K1 = 0.01, K2 = 0.03, of luma as displayed
// (sRGB bytes, Rec. 709 weights); alpha is left out. The mean over the pixels that count, but for those within 5 of the
// border, whose windows are not whole. An empty mask counts all. NaN if none is left.
double ssim(const Image& a, const Image& b, const Mask& mask = {});

// Pixels whose colour differs by at least `levels` of 255 in some channel.
Mask changed_pixels(const Image& a, const Image& b, int levels);

Mask either(const Mask& a, const Mask& b);

// Blocks of `by` x `by` pixels of which any counts, as shrunk() makes them of an image; `width` and `height` of `mask`.
Mask shrunk(const Mask& mask, int width, int height, int by);

} // namespace coif
