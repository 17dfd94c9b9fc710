#include "app/traced/tracer.h"

#include "app/traced/rays.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <thread>

namespace coif
{

static constexpr double kPi = std::numbers::pi;
static constexpr int kAllLights = 2;    // bounces up to which each light is asked; later one, by chance
static constexpr int kSafe = 3;         // bounces that no path is ended before, by chance
static constexpr double kTrifle = 1e-6; // of its light that a path is ended with
static constexpr uint32_t kAtOnce = 64; // samples of a pixel, at most: a stop waits for the end of a row

uint32_t Accumulation::fewest() const { return samples.empty() ? 0 : *std::ranges::min_element(samples); }

Accumulation empty_accumulation(int width, int height)
{
    return {width, height, std::vector<uint32_t>(size_t(height)),
            std::vector<glm::vec4>(size_t(width) * size_t(height), glm::vec4(0.0f))};
}

namespace
{
// SplitMix64 (Steele, Lea, Flood. Fast splittable pseudorandom number generators. 2014).
struct Random
{
    uint64_t state;
    uint64_t bits()
    {
        uint64_t z = state += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    double operator()() { return double(bits() >> 11) * 0x1p-53; }
};

} // namespace

struct Tracer::Embree : TracedRays
{
    std::vector<double> light_share; // of each sun among all, up to it: what one is chosen by
    std::vector<double> light_chance;

    explicit Embree(TracedScene scene);

    glm::dvec3 light_of(Ray ray, Random& random, int bounces, bool& hit) const;
    template <typename Receive> glm::dvec3 from_lights(Random& random, int bounce, const Receive& receive) const;
    Ray ray_of(int x, int y, int width, int height, Random& random) const;
    glm::vec4 sample(int x, int y, int width, int height, Random random, int bounces) const;
};

Tracer::Embree::Embree(TracedScene traced) : TracedRays(std::move(traced))
{
    double sum = 0.0;
    for (const Sun& sun : of.lighting.suns)
    {
        light_chance.push_back(double(sun.irradiance.x) + sun.irradiance.y + sun.irradiance.z);
        light_share.push_back(sum += light_chance.back());
    }
    for (size_t i = 0; sum > 0.0 && i < light_share.size(); ++i)
    {
        light_share[i] /= sum;
        light_chance[i] /= sum;
    }
}

// Two ways across a third, all of unit length.
static void frame_of(const glm::dvec3& n, glm::dvec3& x, glm::dvec3& y)
{
    x = glm::normalize(glm::cross(std::abs(n.x) > 0.5 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), n));
    y = glm::cross(n, x);
}

// What `receive` makes of each light: it is given the way to it, and gives radiance per irradiance, shadow and all.
template <typename Receive>
glm::dvec3 Tracer::Embree::from_lights(Random& random, int bounce, const Receive& receive) const
{
    glm::dvec3 sum(0.0);
    const std::vector<Sun>& suns = of.lighting.suns;
    const bool one = bounce > kAllLights && suns.size() > 1;
    const double chosen = one ? random() : 0.0;
    for (size_t i = 0; i < suns.size(); ++i)
    {
        if (one && (chosen >= light_share[i] || (i > 0 && chosen < light_share[i - 1])))
            continue;
        if (!(light_chance[i] > 0.0))
            continue;
        glm::dvec3 way(suns[i].direction);
        if (suns[i].radius > 0.0f)
        {
            // Anywhere in its disc, whose irradiance is spread evenly.
            const double cosine = 1.0 - random() * (1.0 - std::cos(double(suns[i].radius))),
                         turn = 2.0 * kPi * random();
            const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
            glm::dvec3 x, y;
            frame_of(way, x, y);
            way = glm::normalize(cosine * way + sine * (std::cos(turn) * x + std::sin(turn) * y));
        }
        sum += receive(way) * glm::dvec3(suns[i].irradiance) / (one ? light_chance[i] : 1.0);
    }
    return sum;
}

// Is it the ground that a ray stops at? Where there is only a share of it, by chance.
static bool lands(const OnGround& ground, const RTCRayHit& met, Random& random)
{
    return ground.share > 0.0 && ground.far < double(met.ray.tfar) && random() < ground.share;
}

// Radiance that comes back along a ray. `hit`: it meets something.
glm::dvec3 Tracer::Embree::light_of(Ray ray, Random& random, int bounces, bool& hit) const
{
    glm::dvec3 light(0.0), share(1.0);
    hit = false;
    for (int bounce = 0; bounce <= bounces; ++bounce)
    {
        const RTCRayHit met = meet(ray);
        const OnGround ground = ground_along(ray);
        const bool grounded = lands(ground, met, random);
        if (!grounded && met.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        {
            if (bounce > 0)
                light += share * glm::dvec3(of.lighting.sky);
            break;
        }
        hit = true;
        const glm::dvec3 to_eye = -ray.way;
        if (grounded || met.hit.geomID == solids_id)
        {
            const SolidPlace place =
                grounded ? ground_place(ray.from + ground.far * ray.way) : solid_place(met, to_eye);
            glm::dvec3 x, y;
            frame_of(place.normal, x, y);
            const auto turned = [&](const glm::dvec3& way)
            { return glm::dvec3(glm::dot(way, x), glm::dot(way, y), glm::dot(way, place.normal)); };
            const glm::dvec3 eye = turned(to_eye);
            light += share * from_lights(random, bounce,
                                         [&](const glm::dvec3& way)
                                         {
                                             const glm::dvec3 scattered = scatter(place.look, eye, turned(way));
                                             if (!(scattered.x + scattered.y + scattered.z > 0.0) ||
                                                 !(glm::dot(place.face, way) > 0.0))
                                                 return glm::dvec3(0.0);
                                             return scattered * reaches(Ray{place.at, way});
                                         });
            const double first = random(), second = random();
            const SolidSample next =
                coif::sample(place.look, eye, {first, second, place.look.gloss > 0.0 ? random() : 0.0});
            const glm::dvec3 way = next.to_light;
            ray = Ray{place.at, glm::normalize(way.x * x + way.y * y + way.z * place.normal)};
            share *= next.weight;
            if (!(glm::dot(ray.way, place.face) > 0.0))
                break; // into the solid, which only the smooth normal looks along
        }
        else
        {
            const glm::dvec3 surface = face_of(met);
            alignas(16) float p[4], d[4];
            rtcInterpolate1(strands, met.hit.primID, met.hit.u, met.hit.v, RTC_BUFFER_TYPE_VERTEX, 0, p, d, nullptr, 4);
            const glm::dvec3 way_on(d[0], d[1], d[2]);
            const double radius = p[3], length = glm::length(way_on);
            glm::dvec3 along, side, other; // root to tip; towards the eye across that; the third
            along = length > 1e-12 ? way_on / length : glm::dvec3(0, 1, 0);
            const double sin_o = std::clamp(glm::dot(to_eye, along), -1.0, 1.0);
            side = to_eye - sin_o * along;
            const double seen = glm::length(side);
            if (seen > 1e-7)
                side /= seen;
            else
                frame_of(along, side, other);
            other = glm::cross(side, along);

            const size_t pieces = of.points - 1, strand = met.hit.primID / pieces, piece = met.hit.primID % pieces;
            const glm::vec3* sigma = &of.absorption[strand * of.points + piece];
            const FibreNear fibre = {of.fibre, std::clamp(-glm::dot(surface, other), -1.0, 1.0),
                                     glm::dvec3(glm::mix(sigma[0], sigma[1], met.hit.u))};
            const glm::dvec3 at = ray.from + double(met.ray.tfar) * ray.way;
            const auto leaving = [&](const glm::dvec3& way, double sin_i)
            {
                const double across = std::sqrt(std::max(0.0, 1.0 - sin_i * sin_i));
                return Ray{at, way, strand, 2.5 * radius / std::max(0.1, across)};
            };
            light += share * from_lights(random, bounce,
                                         [&](const glm::dvec3& way)
                                         {
                                             const double sin_i = std::clamp(glm::dot(way, along), -1.0, 1.0);
                                             const double phi = std::atan2(glm::dot(way, other), glm::dot(way, side));
                                             const glm::dvec3 scattered = scatter(fibre, sin_o, sin_i, phi);
                                             if (!(scattered.x + scattered.y + scattered.z > 1e-9))
                                                 return glm::dvec3(0.0);
                                             return scattered * reaches(leaving(way, sin_i));
                                         });
            const std::array<double, 4> numbers = {random(), random(), random(), random()};
            const FibreSample next = coif::sample(fibre, sin_o, numbers);
            if (!(next.pdf > 0.0))
                break;
            const double cos_i = std::sqrt(std::max(0.0, 1.0 - next.sin_i * next.sin_i));
            ray = leaving(
                glm::normalize(next.sin_i * along + cos_i * (std::cos(next.phi) * side + std::sin(next.phi) * other)),
                next.sin_i);
            share *= next.weight;
        }
        const double most = std::max({share.x, share.y, share.z});
        if (!(most > kTrifle))
            break;
        if (bounce >= kSafe) // Russian roulette (Arvo, Kirk 1990)
        {
            const double on = std::min(0.97, most);
            if (random() >= on)
                break;
            share /= on;
        }
    }
    return light;
}

// Through anywhere in a pixel, and anywhere in the lens.
Ray Tracer::Embree::ray_of(int x, int y, int width, int height, Random& random) const
{
    const double pixel = 2.0 * of.tangent / height; // at a distance of one
    const double right = (x + random() - 0.5 * width) * pixel, up = (0.5 * height - y - random()) * pixel;
    Ray ray = {of.eye, glm::normalize(of.forward + right * of.right + up * of.up)};
    if (of.lens > 0.0)
    {
        const double radius = of.lens * std::sqrt(random()), turn = 2.0 * kPi * random();
        const glm::dvec3 sharp = of.eye + of.focus * (of.forward + right * of.right + up * of.up);
        ray.from += radius * (std::cos(turn) * of.right + std::sin(turn) * of.up);
        ray.way = glm::normalize(sharp - ray.from);
    }
    return ray;
}

glm::vec4 Tracer::Embree::sample(int x, int y, int width, int height, Random random, int bounces) const
{
    bool hit = false;
    const Ray ray = ray_of(x, y, width, height, random);
    const glm::dvec3 light = light_of(ray, random, bounces, hit);
    if (!std::isfinite(light.x + light.y + light.z))
        return glm::vec4(0.0f);
    return glm::vec4(glm::vec3(light), hit ? 1.0f : 0.0f);
}

Tracer::Tracer(TracedScene scene) : embree_(std::make_unique<Embree>(std::move(scene)))
{
    embree_->check("sort the strands");
}
Tracer::~Tracer() = default;
const TracedScene& Tracer::scene() const { return embree_->of; }

std::vector<float> Tracer::hair(int width, int height, int samples) const
{
    std::vector<float> share(size_t(width) * size_t(height), 0.0f);
    Random random{0};
    for (size_t pixel = 0; pixel < share.size(); ++pixel)
        for (int s = 0; s < samples; ++s)
        {
            const Ray ray =
                embree_->ray_of(int(pixel % size_t(width)), int(pixel / size_t(width)), width, height, random);
            const RTCRayHit met = embree_->meet(ray);
            if (met.hit.geomID != RTC_INVALID_GEOMETRY_ID && met.hit.geomID == embree_->strands_id &&
                !lands(embree_->ground_along(ray), met, random))
                share[pixel] += 1.0f / float(samples);
        }
    return share;
}

static uint64_t mixed(uint64_t a, uint64_t b) { return Random{a ^ b * 0xd1342543de82ef95u}.bits(); }

void Tracer::trace(Accumulation& picture, uint32_t samples, const TraceLimits& limits, const TraceSays& says) const
{
    using Clock = std::chrono::steady_clock;
    const size_t rows = size_t(picture.height);
    const unsigned threads =
        limits.threads > 0 ? unsigned(limits.threads) : std::max(1u, std::thread::hardware_concurrency());
    std::vector<double> seconds(rows), taken(rows); // this run's, of each row and its samples
    std::atomic<bool> stop = false;
    std::atomic<size_t> next = 0;
    std::mutex one;
    Clock::time_point said;

    // What is left is reckoned by what the rows have taken: those with hair in them take most.
    const auto say = [&]
    {
        double spent = 0.0, left = 0.0, all = 0.0, done = 0.0, known = 0.0;
        for (size_t y = 0; y < rows; ++y)
        {
            spent += seconds[y];
            known += taken[y];
        }
        for (size_t y = 0; y < rows; ++y)
        {
            const double each = taken[y] > 0.0 ? seconds[y] / taken[y] : spent / std::max(known, 1.0);
            left += each * double(samples - std::min(samples, picture.samples[y]));
            all += double(samples);
            done += double(std::min(samples, picture.samples[y]));
        }
        if (!says(done / std::max(all, 1.0), left / threads))
            stop = true;
    };
    const auto work = [&](uint32_t until)
    {
        for (size_t y = next++; y < rows && !stop; y = next++)
        {
            const Clock::time_point begin = Clock::now();
            const uint32_t from = picture.samples[y];
            for (int x = 0; x < picture.width; ++x)
            {
                const size_t pixel = y * size_t(picture.width) + size_t(x);
                const uint64_t own = mixed(limits.seed, pixel);
                for (uint32_t s = from; s < until; ++s)
                    picture.sum[pixel] += embree_->sample(x, int(y), picture.width, picture.height,
                                                          Random{mixed(own, s)}, limits.bounces);
            }
            const std::lock_guard lock(one);
            picture.samples[y] = std::max(from, until);
            seconds[y] += std::chrono::duration<double>(Clock::now() - begin).count();
            taken[y] += double(picture.samples[y] - from);
            if (says && Clock::now() - said > std::chrono::milliseconds(200))
            {
                said = Clock::now();
                say();
            }
        }
    };
    // The whole picture again and again, with up to twice the samples each time: what is stopped early is whole.
    for (uint32_t until = std::min(samples, picture.fewest() + 1); !stop;
         until = std::min({samples, 2 * until, until + kAtOnce}))
    {
        next = 0;
        std::vector<std::thread> others;
        for (unsigned i = 1; i < threads; ++i)
            others.emplace_back(work, until);
        work(until);
        for (std::thread& other : others)
            other.join();
        if (until >= samples)
            break;
    }
}

} // namespace coif
