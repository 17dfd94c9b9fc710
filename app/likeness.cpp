// Neither pixel by pixel: a strand's glint is noise to a tracer and to what is held against it. What counts is how much
// light there is in each channel, where it is over half a dozen pixels, and the locks.
#include "app/likeness.h"

#include "app/display.h"
#include "app/ssim.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace coif
{

static constexpr float kHair = 0.9f; // share of a pixel that makes it the hair's: skin that shows through is brighter
static constexpr double kFar = 6.0, kLocks = 2.0; // pixels that pictures are blurred by

// Gaussian, separable, of all channels; the border is repeated.
static std::vector<float> blurred(const std::vector<float>& values, int width, int height, int channels, double sigma)
{
    const int reach = int(std::ceil(3.0 * sigma));
    std::vector<double> weight;
    double all = 0.0;
    for (int d = -reach; d <= reach; ++d)
    {
        weight.push_back(std::exp(-0.5 * d * d / (sigma * sigma)));
        all += weight.back();
    }
    std::vector<float> from = values, to(values.size());
    for (const bool across : {true, false})
    {
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (int c = 0; c < channels; ++c)
                {
                    double sum = 0.0;
                    for (int d = -reach; d <= reach; ++d)
                    {
                        const int i = across ? std::clamp(x + d, 0, width - 1) : x;
                        const int j = across ? y : std::clamp(y + d, 0, height - 1);
                        sum += weight[size_t(d + reach)] * double(from[size_t((j * width + i) * channels + c)]);
                    }
                    to[size_t((y * width + x) * channels + c)] = float(sum / all);
                }
        std::swap(from, to);
    }
    return from;
}

// As it is shown, blurred to the size of locks.
static Image locks_of(const LinearImage& light, const HairParams& params)
{
    Image image = displayed(light, params);
    const std::vector<float> bytes(image.pixels.begin(), image.pixels.end());
    const std::vector<float> soft = blurred(bytes, image.width, image.height, 4, kLocks);
    for (size_t i = 0; i < soft.size(); ++i)
        image.pixels[i] = static_cast<unsigned char>(soft[i] + 0.5f);
    return image;
}

Likeness likeness(const LinearImage& image, const LinearImage& reference, const std::vector<float>& hair,
                  const HairParams& params)
{
    Likeness like;
    glm::dvec3 ours(0.0), theirs(0.0);
    Mask mask(hair.size());
    std::vector<float> covered[2];
    for (size_t i = 0; i < hair.size(); ++i)
    {
        mask[i] = hair[i] > kHair;
        for (int c = 0; c < 3; ++c)
        {
            const float a = image.pixels[4 * i + size_t(c)], b = reference.pixels[4 * i + size_t(c)];
            covered[0].push_back(a * hair[i]);
            covered[1].push_back(b * hair[i]);
            if (mask[i])
            {
                ours[c] += double(a);
                theirs[c] += double(b);
            }
        }
    }
    for (int c = 0; c < 3; ++c)
        like.radiance[c] = theirs[c] > 0.0 ? ours[c] / theirs[c] : NAN;
    const std::vector<float> a = blurred(covered[0], image.width, image.height, 3, kFar);
    const std::vector<float> b = blurred(covered[1], image.width, image.height, 3, kFar);
    double off = 0.0, size = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
        if (mask[i / 3])
        {
            off += double(a[i] - b[i]) * double(a[i] - b[i]);
            size += double(b[i]) * double(b[i]);
        }
    like.roughly = size > 0.0 ? std::sqrt(off / size) : NAN;
    like.locks = ssim(locks_of(image, params), locks_of(reference, params), mask);
    return like;
}

std::string likeness_text(const Likeness& like)
{
    if (std::isnan(like.roughly))
        return "no light on hair to hold it against";
    return fmt::format("has {:.2f} {:.2f} {:.2f} of the light, {:.0f} % off", like.radiance[0], like.radiance[1],
                       like.radiance[2], 100.0 * like.roughly);
}

} // namespace coif
