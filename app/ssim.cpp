#include "app/ssim.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>

namespace coif
{

static constexpr int kReach = 5; // pixels from a window's middle to its edge

static std::vector<double> luma(const Image& image)
{
    std::vector<double> out;
    out.reserve(image.pixels.size() / 4);
    for (size_t i = 0; i < image.pixels.size(); i += 4)
        out.push_back(0.2126 * image.pixels[i] + 0.7152 * image.pixels[i + 1] + 0.0722 * image.pixels[i + 2]);
    return out;
}

static std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b)
{
    std::vector<double> out(a.size());
    for (size_t i = 0; i < a.size(); ++i)
        out[i] = a[i] * b[i];
    return out;
}

// Weighted means of all whole windows; elsewhere zero.
static std::vector<double> window_means(const std::vector<double>& values, int width, int height)
{
    std::array<double, 2 * kReach + 1> weight;
    double sum = 0.0;
    for (int d = -kReach; d <= kReach; ++d)
        sum += weight[size_t(d + kReach)] = std::exp(-0.5 * d * d / (1.5 * 1.5));
    std::vector<double> rows(values.size()), means(values.size());
    for (int y = 0; y < height; ++y)
        for (int x = kReach; x < width - kReach; ++x)
            for (int d = -kReach; d <= kReach; ++d)
                rows[size_t(y * width + x)] += weight[size_t(d + kReach)] / sum * values[size_t(y * width + x + d)];
    for (int y = kReach; y < height - kReach; ++y)
        for (int x = kReach; x < width - kReach; ++x)
            for (int d = -kReach; d <= kReach; ++d)
                means[size_t(y * width + x)] += weight[size_t(d + kReach)] / sum * rows[size_t((y + d) * width + x)];
    return means;
}

double ssim(const Image& a, const Image& b, const Mask& mask)
{
    assert(a.width == b.width && a.height == b.height && (mask.empty() || mask.size() == a.pixels.size() / 4));
    const int width = a.width, height = a.height;
    const std::vector<double> x = luma(a), y = luma(b);
    const auto means = [&](const std::vector<double>& values) { return window_means(values, width, height); };
    const std::vector<double> mx = means(x), my = means(y);
    const std::vector<double> xx = means(product(x, x)), yy = means(product(y, y)), xy = means(product(x, y));
    const double c1 = 0.01 * 255.0 * 0.01 * 255.0, c2 = 0.03 * 255.0 * 0.03 * 255.0;
    double sum = 0.0;
    long count = 0;
    for (int j = kReach; j < height - kReach; ++j)
        for (int i = kReach; i < width - kReach; ++i)
        {
            const size_t p = size_t(j * width + i);
            if (!mask.empty() && !mask[p])
                continue;
            const double product_of_means = mx[p] * my[p], squares = mx[p] * mx[p] + my[p] * my[p];
            // Eq. 13.
            sum += (2.0 * product_of_means + c1) * (2.0 * (xy[p] - product_of_means) + c2) /
                   ((squares + c1) * (xx[p] + yy[p] - squares + c2));
            ++count;
        }
    return count ? sum / double(count) : NAN;
}

Mask changed_pixels(const Image& a, const Image& b, int levels)
{
    assert(a.pixels.size() == b.pixels.size());
    Mask mask(a.pixels.size() / 4);
    for (size_t i = 0; i < mask.size(); ++i)
        for (size_t c = 0; c < 3; ++c)
            if (std::abs(int(a.pixels[4 * i + c]) - int(b.pixels[4 * i + c])) >= levels)
                mask[i] = true;
    return mask;
}

Mask either(const Mask& a, const Mask& b)
{
    Mask both = a;
    for (size_t i = 0; i < both.size(); ++i)
        both[i] = a[i] || b[i];
    return both;
}

Mask shrunk(const Mask& mask, int width, int height, int by)
{
    const int wide = width / by, high = height / by;
    Mask small(size_t(wide * high));
    for (int y = 0; y < high * by; ++y)
        for (int x = 0; x < wide * by; ++x)
            if (mask[size_t(y * width + x)])
                small[size_t(y / by * wide + x / by)] = true;
    return small;
}

} // namespace coif
