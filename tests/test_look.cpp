// Light in the hair: the passes of kernels/look.h against their double-precision twins, and what must hold of them.
#include "app/look_level.h"
#include "app/traced/solid.h"
#include "sim/wave.h"
#include "tests/on_device.h"
#include "tests/oracle_look.h"
#include "tests/pixels.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>

namespace coif
{
namespace
{

using oracle::Vec, oracle::xyz;

constexpr int kNodes = 12;
const glm::vec3 kEye(0.3f, 0.1f, 0.9f);

struct Tress
{
    std::vector<glm::vec3> nodes; // m; the first lies under the scalp
    glm::vec3 root{0.5f}, tip{0.5f};
    float width = 0.002f, opacity = 1.0f;
};

HairParams plain_params()
{
    HairParams p;
    p.strand_nodes = kNodes;
    p.grid_resolution = 16;
    p.forces_repulsion = 0.0f;
    p.look_volume = 44;
    p.look_taper = p.look_variation = 0.0f;
    p.wave_normal_amplitude = p.wave_binormal_amplitude = 0.0f;
    return p;
}

Lighting light_from(std::initializer_list<glm::vec3> directions, glm::vec3 sky = glm::vec3(0.0f))
{
    Lighting lighting;
    for (const glm::vec3& d : directions)
        lighting.suns.push_back({glm::normalize(d), {2.0f, 1.8f, 1.5f}, 0.0f});
    lighting.sky = sky;
    return lighting;
}

// Kernels that are built once for all tests.
Device kept(Device device)
{
    static const auto built = std::make_shared<std::map<std::string, Kernel>>();
    device.built = built;
    return device;
}

const glm::vec3 kBall(0.12f, -0.05f, 0.02f);
constexpr float kBallRadius = 0.04f;

// Places all over a ball.
std::vector<LookSurface> skin_of_ball(glm::vec3 middle, float radius, glm::vec3 albedo, int count = 500)
{
    Random random(12);
    std::vector<LookSurface> skin;
    for (int i = 0; i < count; ++i)
    {
        const glm::vec3 n(random.direction()), at = middle + radius * n;
        skin.push_back({F4(at.x, at.y, at.z, 1.0f), F4(n.x, n.y, n.z, 0.0f), F4(albedo.x, albedo.y, albedo.z, 1.0f)});
    }
    return skin;
}

// Strands that lie where they are said to, and the light in them.
class Hair
{
  public:
    explicit Hair(const std::vector<Tress>& tresses, const HairParams& authored = plain_params(), bool bodies = false,
                  const Device& device = test_device())
        : device_(kept(device)), params(device_params(authored)), shading(device_)
    {
        Groom groom = one_strand(kNodes, 0.1f, {0.0f, 0.1f, 0.0f}, {0.0f, 1.0f, 0.0f});
        groom.drawn.resize(tresses.size());
        groom.drawn_multi = int(tresses.size());
        std::vector<float4> positions, frames;
        for (size_t s = 0; s < tresses.size(); ++s)
        {
            const Tress& t = tresses[s];
            StrandLook look = {};
            look.root_color = F4(t.root.x, t.root.y, t.root.z, t.width);
            look.tip_color = F4(t.tip.x, t.tip.y, t.tip.z, t.opacity);
            look.own.x = float(s);
            groom.looks.push_back(look);
            groom.drawn[s].weights = F4(1.0f, 0.0f, 0.0f, 0.0f);
            groom.drawn[s].leader = int(s);
            float length = 0.0f;
            for (size_t k = 0; k < t.nodes.size(); ++k)
            {
                length += k > 1 ? glm::distance(t.nodes[k], t.nodes[k - 1]) : 0.0f;
                positions.push_back(F4(t.nodes[k].x, t.nodes[k].y, t.nodes[k].z, 1.0f));
                frames.push_back(F4(0.0f, 0.0f, 1.0f, length));
            }
        }
        looks = groom.looks;
        solver = std::make_unique<Solver>(device_, authored, groom, Pose{});
        if (bodies)
        {
            solver->set_colliders({{kBall, kBallRadius}, {{-0.1f, 0.1f, 0.0f}, 0.03f, false, {{-0.1f, -0.1f, 0.1f}}}});
            skin = skin_of_ball(kBall, kBallRadius, {0.7f, 0.5f, 0.4f});
            solver->set_body({lumpy_body(), 0.8f, {0.0f, 0.01f, 0.0f}});
        }
        solver->step({{Pose{}, 1.0 / 60.0, 1.0f / 60.0f}});
        solver->draw();
        write(device_, solver->buffers().at("drawn_position"), positions);
        write(device_, solver->buffers().at("drawn_frame"), frames);
    }

    void light(const Lighting& lighting)
    {
        shading.light(
            {solver.get(), params, wave_table(params), {}, lighting, glm::vec3(INFINITY), glm::vec3(-INFINITY), skin});
        suns = lighting.suns.size();
    }

    // Radiance of all places.
    std::vector<glm::vec3> colors(int level, glm::vec3 eye = kEye)
    {
        const std::vector<uint16_t> halves = bits(level, eye);
        std::vector<glm::vec3> found;
        for (size_t i = 0; i < halves.size(); i += 4)
            found.emplace_back(of_half(halves[i]), of_half(halves[i + 1]), of_half(halves[i + 2]));
        return found;
    }
    std::vector<uint16_t> bits(int level, glm::vec3 eye = kEye)
    {
        shading.shade(eye, level, 1.0f);
        return read<uint16_t>(device_, shading.buffers().at("shaded"), places() * 4);
    }

    size_t places() const { return size_t(shading.volume().strands) * size_t(shading.volume().places); }
    template <typename T> std::vector<T> values(const char* name, size_t count) const
    {
        return read<T>(device_, shading.buffers().at(name), count);
    }

    // What the twins read: what the passes before have left.
    oracle::Lit lit() const
    {
        oracle::Lit lit;
        lit.params = params;
        lit.frame = values<LookFrame>("look_frame", 1)[0];
        lit.volume = shading.volume();
        lit.coarse = values<LookVolume>("coarse_volume", 1)[0];
        lit.rays = values<LookRay>("rays", suns);
        lit.depth = values<float>("depth", suns * oracle::voxels_of(lit.volume));
        lit.body_rays = values<LookRay>("body_rays", suns);
        lit.body_depth = values<float>("body_depth", suns * oracle::voxels_of(lit.coarse));
        if (shading.buffers().contains("eye_depth")) // colours have been asked for
        {
            lit.eye_ray = values<LookRay>("eye_rays", 1)[0];
            lit.eye_depth = values<float>("eye_depth", oracle::voxels_of(lit.volume));
        }
        lit.sky = values<float>("sky", 16 * oracle::voxels_of(lit.coarse));
        if (shading.buffers().contains("around"))
            lit.around = values<float>("around", 16 * oracle::voxels_of(lit.coarse));
        lit.table = values<float>("shares", SHARE_ROWS * SHARE_TERMS);
        lit.forward = xyz(values<float4>("forward", 2)[0]);
        lit.from_all_sides = xyz(values<float4>("forward", 2)[1]);
        return lit;
    }

  private:
    Device device_;

  public:
    const HairParams params;
    std::vector<StrandLook> looks;
    std::vector<LookSurface> skin;
    std::unique_ptr<Solver> solver;
    Shading shading;
    size_t suns = 0;
};

// All over a ball of 9 cm, each bent its own way, of all colours.
std::vector<Tress> tangle(int count, float width = 0.002f)
{
    Random random(21);
    std::vector<Tress> tresses;
    for (int s = 0; s < count; ++s)
    {
        Tress t;
        glm::dvec3 at = 0.09 * random.direction(), way = glm::normalize(at) + 0.5 * random.direction();
        for (int k = 0; k < kNodes; ++k)
        {
            t.nodes.emplace_back(at);
            way = glm::normalize(way + 0.4 * random.direction());
            at += 0.012 * way;
        }
        const auto color = [&] { return glm::vec3(random.in(0.02, 0.95), random.in(0.02, 0.9), random.in(0.02, 0.8)); };
        t.root = color();
        t.tip = color();
        t.width = width * float(random.in(0.5, 1.0));
        t.opacity = float(random.in(0.5, 1.0));
        tresses.push_back(t);
    }
    return tresses;
}

const std::initializer_list<glm::vec3> kSixLights = {{0.0f, 1.0f, 0.0f}, {-1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 1.0f},
                                                     {1.0f, 1.0f, 1.0f}, {-1.0f, 0.4f, 0.2f}, {0.45f, 0.75f, 0.6f}};
const glm::vec3 kSky(0.3f, 0.35f, 0.4f);

// One hair with bodies in it, lit from six sides and by the sky, that the tests of single passes share.
class LookPasses : public testing::Test
{
  protected:
    static void SetUpTestSuite()
    {
        HairParams params = plain_params();
        params.look_taper = 0.6f;
        params.look_variation = 0.3f;
        params.look_opacity_along = F4(1.0f, 1.0f, 0.9f, 0.5f);
        hair = std::make_unique<Hair>(tangle(400), params, true);
        hair->light(light_from(kSixLights, kSky));
        volume = hair->shading.volume();
        all = oracle::voxels_of(volume);
        places = hair->values<float4>("places", hair->places());
    }
    static void TearDownTestSuite() { hair.reset(); }

    static std::unique_ptr<Hair> hair;
    static LookVolume volume;
    static size_t all;
    static std::vector<float4> places;
};
std::unique_ptr<Hair> LookPasses::hair;
LookVolume LookPasses::volume;
size_t LookPasses::all;
std::vector<float4> LookPasses::places;

TEST_F(LookPasses, PlacesLieOnTheCurveAndAreAsWideAsItIsOpaque)
{
    const std::vector<Tress> tresses = tangle(400);
    const int pieces = (volume.places - 1) / (kNodes - 2);
    ASSERT_EQ(pieces * (kNodes - 2) + 1, volume.places);
    double worst = 0.0, worst_width = 0.0;
    for (int s = 0; s < volume.strands; ++s)
        for (int k = 0; k < volume.places; ++k)
        {
            const int segment = std::min(k / pieces, kNodes - 3);
            double w[4];
            oracle::curve_weights(hair->params.smoothing_curve, double(k) / pieces - segment, w);
            Vec at(0.0);
            for (int i = 0; i < 4; ++i)
                at += w[i] * Vec(tresses[size_t(s)].nodes[size_t(std::min(segment + i, kNodes - 1))]);
            const float4& found = places[size_t(s * volume.places + k)];
            worst = std::max(worst, glm::distance(at, xyz(found)));
            const double along = double(k) / (volume.places - 1);
            const StrandLook& look = hair->looks[size_t(s)];
            const double width = double(look.root_color.w) * (1.0 - 0.6 * along * along) * double(look.tip_color.w) *
                                 oracle::profile_at(hair->params.look_opacity_along, along);
            worst_width = std::max(worst_width, std::abs(width - double(found.w)));
        }
    EXPECT_LT(worst, 1e-7);
    EXPECT_LT(worst_width, 1e-9);
}

// Up to twice as long as it is wide. Rounding to an eighth of an octave takes or adds a seventh of the voxels at most;
// the voxel about hair and rows of 16 add the rest.
TEST(LookVolumeSize, IsThatOfACubeWhateverTheShapeOfTheHair)
{
    const auto voxels = [](glm::vec3 stretched, int volume)
    {
        HairParams params = plain_params();
        params.look_volume = volume;
        std::vector<Tress> tresses = tangle(100);
        for (Tress& tress : tresses)
            for (glm::vec3& node : tress.nodes)
                node *= stretched;
        Hair hair(tresses, params);
        hair.light(light_from({{0.0f, 1.0f, 0.0f}}));
        return double(oracle::voxels_of(hair.shading.volume())) / std::pow(double(volume), 3);
    };
    for (const int volume : {32, 52})
        for (const glm::vec3 shape : {glm::vec3(1.0f), glm::vec3(0.8f, 1.4f, 0.8f), glm::vec3(1.6f, 1.0f, 0.9f)})
        {
            const double share = voxels(shape, volume);
            EXPECT_GT(share, 0.7) << volume << " " << shape.y;
            EXPECT_LT(share, 2.0) << volume << " " << shape.y;
        }
}

// It lies in no box at all; what is thinner than half its length counts as half as thick.
TEST(LookVolumeSize, OfOneStraightStrandIsFinite)
{
    Tress tress;
    for (int k = 0; k < kNodes; ++k)
        tress.nodes.emplace_back(0.0f, 0.1f - 0.02f * float(k), 0.0f);
    Hair hair({tress});
    hair.light(light_from({{1.0f, 0.0f, 0.0f}}));
    const LookVolume volume = hair.shading.volume();
    EXPECT_GT(volume.corner.w, 0.5f * 0.2f / 44.0f);
    EXPECT_LT(oracle::voxels_of(volume), size_t(2 * 44 * 44 * 44));
}

TEST_F(LookPasses, DensityIsTheTwinsAndLosesNothing)
{
    const std::vector<cl_int4> sums = hair->values<cl_int4>("fibre_sums", all * size_t(volume.copies));
    const std::vector<oracle::Fibres> expected = oracle::fibre_in_voxels(places, volume);
    const double to_area = std::pow(double(volume.corner.w), 2) / double(volume.unit);
    double worst = 0.0, most = 0.0, mass = 0.0, whole = 0.0;
    for (size_t i = 0; i < all; ++i)
        for (size_t axis = 0; axis < 4; ++axis)
        {
            double sum = 0.0;
            for (size_t copy = 0; copy < size_t(volume.copies); ++copy)
                sum += sums[copy * all + i].s[axis] * to_area;
            worst = std::max(worst, std::abs(sum - expected[i][axis]));
            most = std::max(most, expected[i][axis]);
            mass += axis == 3 ? sum : 0.0;
        }
    for (int s = 0; s < volume.strands; ++s)
        for (int k = 0; k + 1 < volume.places; ++k)
        {
            const float4 &a = places[size_t(s * volume.places + k)], &b = places[size_t(s * volume.places + k + 1)];
            whole += glm::distance(xyz(a), xyz(b)) * 0.5 * (double(a.w) + double(b.w));
        }
    EXPECT_LT(worst, 2e-5 * most); // coordinates of 50 voxels are rounded to 3e-6
    EXPECT_NEAR(mass, whole, 1e-6 * whole);
    EXPECT_GT(whole, 0.0);
}

TEST_F(LookPasses, TheVolumeHoldsTheHairAndTheBodiesInIt)
{
    const std::vector<float> fibre = hair->values<float>("fibre", 5 * all);
    const std::vector<oracle::Fibres> hairs = oracle::fibre_in_voxels(places, volume);
    const oracle::Body body = oracle::body_of(*hair->solver->body().grid);
    const std::vector<double> bodies =
        oracle::bodies_in_voxels(hair->solver->placed_colliders(), body, volume, hair->solver->info());
    const double per_volume = std::pow(double(volume.corner.w), -3);
    double worst = 0.0, most = 0.0, worst_way = 0.0;
    int deep = 0, edge = 0;
    for (size_t i = 0; i < all; ++i)
    {
        worst = std::max(worst, std::abs(double(fibre[4 * all + i]) - bodies[i]));
        const double expected = hairs[i][3] * per_volume + bodies[i];
        most = std::max(most, expected);
        worst = std::max(worst, std::abs(double(fibre[3 * all + i]) - expected));
        for (size_t axis = 0; axis < 3; ++axis)
            worst_way = std::max(worst_way, std::abs(double(fibre[axis * all + i]) - hairs[i][axis] * per_volume));
        deep += bodies[i] > 0.99 * 6.0 / (0.7853981634 * double(volume.corner.w));
        edge += bodies[i] > 0.0;
    }
    EXPECT_LT(worst, 3e-5 * most);
    EXPECT_LT(worst_way, 3e-5 * most);
    EXPECT_GT(deep, 20);
    EXPECT_GT(edge, deep + 100);
}

TEST_F(LookPasses, FibresShadeByTheAreaThatTheyTurnToTheLight)
{
    const std::vector<float> fibre = hair->values<float>("fibre", 4 * all);
    const std::vector<LookRay> rays = hair->values<LookRay>("rays", hair->suns);
    const std::vector<float> taken =
        oracle::as_voxels_lie(hair->values<float>("extinction", hair->suns * all), volume, rays);
    double worst = 0.0, most = 0.0;
    for (size_t ray = 0; ray < hair->suns; ++ray)
        for (size_t i = 0; i < all; ++i)
        {
            const oracle::Fibres f = {fibre[i], fibre[all + i], fibre[2 * all + i], fibre[3 * all + i]};
            const double expected = oracle::extinction(f, xyz(rays[ray].direction), 1.0);
            worst = std::max(worst, std::abs(double(taken[ray * all + i]) - expected));
            most = std::max(most, expected);
        }
    EXPECT_LT(worst, 1e-5 * most);
}

TEST_F(LookPasses, SweepsAreTheTwins)
{
    const std::vector<LookRay> rays = hair->values<LookRay>("rays", hair->suns);
    const std::vector<float> taken =
        oracle::as_voxels_lie(hair->values<float>("extinction", hair->suns * all), volume, rays);
    const std::vector<float> depth = hair->values<float>("depth", hair->suns * all);
    for (size_t ray = 0; ray < hair->suns; ++ray)
    {
        const std::vector<double> expected = oracle::sweep(&taken[ray * all], volume, rays[ray]);
        double worst = 0.0, most = 0.0;
        for (size_t i = 0; i < all; ++i)
        {
            const double found = double(depth[ray * all + i]);
            worst = std::max(worst, std::isfinite(found) ? std::abs(found - expected[i]) : INFINITY);
            most = std::max(most, expected[i]);
        }
        EXPECT_LT(worst, 1e-5 * most) << "light " << ray; // as GridPasses.TransmittanceIsTheTwinsFromEverySide
        EXPECT_GT(most, 5.0);
    }
}

// Where the eye's rays have come through SEEN, by hair alone.
TEST_F(LookPasses, WhatIsSeenLiesInFrontOfWhatIsHidden)
{
    hair->bits(LOOK_FAR_FIELD);
    const oracle::Lit lit = hair->lit();
    const std::vector<float> fibre = hair->values<float>("fibre", 5 * all);
    const std::vector<float> taken =
        oracle::as_voxels_lie(hair->values<float>("eye_extinction", all), volume, {lit.eye_ray});
    const Vec l = xyz(lit.eye_ray.direction);
    EXPECT_GT(glm::dot(l, glm::normalize(Vec(kEye))), 0.99);
    double worst = 0.0, most = 0.0;
    for (size_t i = 0; i < all; ++i)
    {
        const double amount = double(fibre[3 * all + i]) - double(fibre[4 * all + i]);
        const oracle::Fibres f = {fibre[i], fibre[all + i], fibre[2 * all + i], amount};
        const double expected = oracle::extinction(f, l, 1.0);
        worst = std::max(worst, std::abs(double(taken[i]) - expected));
        most = std::max(most, expected);
    }
    EXPECT_LT(worst, 1e-4 * most); // bodies take a hundred times as much as hair, and are taken away again
    const std::vector<double> expected = oracle::front(taken.data(), volume, lit.eye_ray);
    double off = 0.0, deepest = 0.0;
    int hidden = 0, far_off = 0;
    for (size_t i = 0; i < all; ++i)
    {
        const double apart = std::abs(double(lit.eye_depth[i]) - expected[i]);
        off += apart;
        far_off += !(apart < 1e-3 * double(volume.corner.w));
        hidden += expected[i] > 0.0;
        deepest = std::max(deepest, expected[i]);
    }
    EXPECT_GT(hidden, 300);
    EXPECT_GT(deepest, 0.05) << "m";
    EXPECT_LT(off / hidden, 1e-4 * double(volume.corner.w));
    EXPECT_LE(far_off, hidden / 100); // whether a depth next to SEEN has reached it, a float's rounding decides
}

// Along the suns' rays, through coarse voxels, bodies alone.
TEST_F(LookPasses, BodiesShadeApartFromHair)
{
    const oracle::Lit lit = hair->lit();
    const size_t coarse = oracle::voxels_of(lit.coarse);
    const std::vector<float> bodies = hair->values<float>("coarse_fibre", 5 * coarse);
    const std::vector<float> taken =
        oracle::as_voxels_lie(hair->values<float>("body_extinction", hair->suns * coarse), lit.coarse, lit.body_rays);
    for (size_t ray = 0; ray < hair->suns; ++ray)
    {
        EXPECT_LT(glm::distance(xyz(lit.body_rays[ray].direction), xyz(lit.rays[ray].direction)), 1e-6);
        double worst = 0.0, most = 0.0;
        for (size_t i = 0; i < coarse; ++i)
        {
            const oracle::Fibres body = {0.0, 0.0, 0.0, double(bodies[4 * coarse + i])};
            const double expected = oracle::extinction(body, xyz(lit.rays[ray].direction), 1.0);
            worst = std::max(worst, std::abs(double(taken[ray * coarse + i]) - expected));
            most = std::max(most, expected);
        }
        EXPECT_LT(worst, 1e-5 * most);
        EXPECT_GT(most, 100.0) << "1/m, within the ball";
        const std::vector<double> swept = oracle::sweep(&taken[ray * coarse], lit.coarse, lit.body_rays[ray]);
        worst = most = 0.0;
        for (size_t i = 0; i < coarse; ++i)
        {
            worst = std::max(worst, std::abs(double(lit.body_depth[ray * coarse + i]) - swept[i]));
            most = std::max(most, swept[i]);
        }
        EXPECT_LT(worst, 1e-5 * most);
    }
}

// Lights that lean are swept in steps of up to 1.7 voxels, and read between rays: shadows of bodies are softer by a
// voxel.
TEST_F(LookPasses, WhatASweepLeavesIsWhatAMarchFinds)
{
    const oracle::Lit lit = hair->lit();
    const std::vector<LookRay>& rays = lit.rays;
    const std::vector<float> taken =
        oracle::as_voxels_lie(hair->values<float>("extinction", hair->suns * all), volume, rays);
    for (size_t ray = 0; ray < rays.size(); ++ray)
    {
        const Vec l = xyz(rays[ray].direction);
        double off = 0.0, shade = 0.0;
        int points = 0;
        for (size_t i = 0; i < places.size(); i += 3)
        {
            const Vec at = oracle::in_voxels(xyz(places[i]), volume) + 0.5 * l;
            const double marched = std::exp(-oracle::march(&taken[ray * all], volume, at, l));
            const double swept = std::exp(-oracle::depth_at(&lit.depth[ray * all], volume, rays[ray], at));
            off += std::abs(marched - swept);
            shade += marched;
            ++points;
        }
        EXPECT_LT(off / points, 0.03) << "light " << ray;
        EXPECT_GT(shade / points, 0.05);
        EXPECT_LT(shade / points, 0.95);
    }
}

TEST_F(LookPasses, TheSkyIsWhatAMarchIn26DirectionsFinds)
{
    const oracle::Lit lit = hair->lit();
    const size_t coarse = oracle::voxels_of(lit.coarse);
    const std::vector<LookRay> rays = hair->values<LookRay>("sky_rays", SKY_RAYS);
    const std::vector<float> depth = hair->values<float>("sky_depth", SKY_RAYS * coarse);
    const std::vector<float> taken =
        oracle::as_voxels_lie(hair->values<float>("sky_extinction", SKY_RAYS * coarse), lit.coarse, rays);
    const std::vector<float> fine = hair->values<float>("fibre", 5 * all);
    const std::vector<float> mean = hair->values<float>("coarse_fibre", 5 * coarse);
    for (size_t plane = 0; plane < 5; ++plane) // nothing is lost between fine voxels and coarse ones
    {
        double sum = 0.0, coarse_sum = 0.0, most = 0.0;
        for (size_t i = 0; i < all; ++i)
            sum += double(fine[plane * all + i]), most += std::abs(double(fine[plane * all + i]));
        for (size_t i = 0; i < coarse; ++i)
            coarse_sum += 27.0 * double(mean[plane * coarse + i]);
        EXPECT_NEAR(coarse_sum, sum, 1e-5 * most) << plane;
    }
    const std::vector<oracle::Step> steps =
        oracle::steps_of(mean, {}, {}, lit.coarse, double(lit.params.look_self_shadow), lit.from_all_sides);
    double worst = 0.0, off_twin = 0.0, off = 0.0, off_lean = 0.0, beside_bodies = 0.0;
    int voxels = 0;
    for (int z = 0; z < lit.coarse.z; ++z)
        for (int y = 0; y < lit.coarse.y; ++y)
            for (int x = 0; x < lit.coarse.x; ++x)
            {
                const size_t voxel = size_t(x) + size_t(lit.coarse.x) * (size_t(y) + size_t(lit.coarse.y) * size_t(z));
                if (mean[3 * coarse + voxel] <= 0.0f)
                    continue; // no hair comes there
                std::array<double, 16> twin = {}, marched = {};
                for (size_t i = 0; i < SKY_RAYS; ++i)
                {
                    const Vec d = xyz(rays[i].direction);
                    const double tau[2] = {oracle::depth_at(&depth[i * coarse], lit.coarse, rays[i], Vec(x, y, z)),
                                           oracle::march(&taken[i * coarse], lit.coarse, Vec(x, y, z), d)};
                    const double open = oracle::step_along(steps, lit.coarse, {x, y, z}, rays[i]).open;
                    beside_bodies += open < 0.5;
                    for (size_t c = 0; c < 4; ++c)
                        for (size_t of = 0; of < 2; ++of)
                        {
                            const double all_sides = c == 0 ? 0.0 : lit.from_all_sides[int(c) - 1];
                            const double left =
                                (c == 0 ? 1.0 : open) * std::exp(-tau[of] * (1.0 - all_sides)) / SKY_RAYS;
                            std::array<double, 16>& sums = of == 0 ? twin : marched;
                            sums[c] += left;
                            for (int axis = 0; axis < 3; ++axis)
                                sums[4 + 4 * size_t(axis) + c] += 3.0 * d[axis] * left;
                        }
                }
                for (size_t i = 0; i < 16; ++i)
                {
                    const double found = double(lit.sky[16 * voxel + i]);
                    worst = std::max(worst, std::abs(found - twin[i]));
                    off_twin += std::abs(found - twin[i]);
                    (i < 4 ? off : off_lean) += std::abs(found - marched[i]);
                }
                ++voxels;
            }
    EXPECT_GT(voxels, 200);
    EXPECT_GT(beside_bodies, 200);
    // Where a ray just reaches the volume's side, a float's rounding decides whether it is read.
    EXPECT_LT(off_twin / voxels / 16, 1e-5);
    EXPECT_LT(worst, 0.01);
    EXPECT_LT(off / voxels / 4, 0.03);
    EXPECT_LT(off_lean / voxels / 12, 0.03);
}

// Of the skin in a coarse voxel one point stands for all: their mean.
TEST_F(LookPasses, SkinIsGatheredInCoarseVoxels)
{
    hair->light(light_from(kSixLights, kSky));
    const LookVolume coarse = hair->lit().coarse;
    const std::vector<int> skin_in = hair->values<int>("skin_in", oracle::voxels_of(coarse));
    std::map<size_t, std::vector<LookSurface>> expected;
    for (const LookSurface& s : hair->skin)
    {
        const Vec at = glm::floor(oracle::in_voxels(xyz(s.position), coarse) + 0.5);
        ASSERT_TRUE(glm::all(glm::greaterThanEqual(at, Vec(0.0))) &&
                    glm::all(glm::lessThan(at, Vec(coarse.x, coarse.y, coarse.z))));
        expected[size_t(at.x) + size_t(coarse.x) * (size_t(at.y) + size_t(coarse.y) * size_t(at.z))].push_back(s);
    }
    ASSERT_GT(expected.size(), 20u);
    const std::vector<LookSurface> points = hair->values<LookSurface>("surfaces", expected.size());
    size_t with_skin = 0;
    for (size_t voxel = 0; voxel < skin_in.size(); ++voxel)
    {
        ASSERT_EQ(skin_in[voxel] >= 0, expected.contains(voxel));
        if (skin_in[voxel] < 0)
            continue;
        ++with_skin;
        Vec at(0.0), n(0.0);
        for (const LookSurface& s : expected[voxel])
        {
            at += xyz(s.position) / double(expected[voxel].size());
            n += xyz(s.normal);
        }
        const LookSurface& point = points[size_t(skin_in[voxel])];
        EXPECT_LT(glm::distance(xyz(point.position), at), 1e-6);
        EXPECT_LT(glm::distance(xyz(point.normal), glm::normalize(n)), 1e-5);
        EXPECT_NEAR(point.albedo.x, 0.7f, 1e-5);
        EXPECT_EQ(point.position.w, SENDS_ABOVE);
        EXPECT_EQ(point.normal.w, 0.0f) << "it does not shine";
    }
    EXPECT_EQ(with_skin, expected.size());
}

TEST_F(LookPasses, SkinSendsBackWhatTheTwinSays)
{
    hair->light(light_from(kSixLights, kSky));
    const oracle::Lit lit = hair->lit();
    const LookVolume coarse = lit.coarse;
    const size_t count = oracle::voxels_of(coarse);
    const std::vector<int> skin_in = hair->values<int>("skin_in", count);
    const std::vector<float4> sent = hair->values<float4>("lit", size_t(std::ranges::max(skin_in)) + 1);
    const std::vector<oracle::Step> steps =
        oracle::steps_of(hair->values<float>("coarse_fibre", 5 * count), skin_in, sent, coarse,
                         double(lit.params.look_self_shadow), lit.from_all_sides);
    const std::vector<LookRay> rays = hair->values<LookRay>("sky_rays", SKY_RAYS);
    const std::vector<float> found = hair->values<float>("bounced", 16 * count);
    double worst = 0.0, most = 0.0;
    int voxels = 0, lean = 0, beside = 0;
    for (int z = 0; z < coarse.z; ++z)
        for (int y = 0; y < coarse.y; ++y)
            for (int x = 0; x < coarse.x; ++x)
            {
                const size_t at = size_t(x) + size_t(coarse.x) * (size_t(y) + size_t(coarse.y) * size_t(z));
                if (!(steps[at].depth > 0.0))
                    continue; // nothing there reads it
                std::array<double, 16> expected = {};
                for (const LookRay& ray : rays)
                {
                    const Vec comes = oracle::step_along(steps, coarse, {x, y, z}, ray).comes / double(SKY_RAYS);
                    for (int c = 0; c < 3; ++c)
                        for (int moment = 0; moment < 4; ++moment)
                            expected[size_t(4 * moment + c)] +=
                                comes[c] * (moment == 0 ? 1.0 : 3.0 * xyz(ray.direction)[moment - 1]);
                }
                for (size_t i = 0; i < 16; ++i)
                    if (i % 4 != 3) // nothing
                        worst = std::max(worst, std::abs(double(found[16 * at + i]) - expected[i]));
                most = std::max(most, expected[0]);
                ++voxels;
                const Vec to_ball = Vec(kBall) - (xyz(coarse.corner) + (Vec(x, y, z) + 0.5) * double(coarse.corner.w));
                if (glm::length(to_ball) > 1.5 * double(kBallRadius) && expected[0] > 1e-3)
                {
                    ++beside;
                    lean += glm::dot(Vec(expected[4], expected[8], expected[12]), to_ball) > 0.0;
                }
            }
    EXPECT_GT(voxels, 200);
    EXPECT_GT(most, 0.02);
    EXPECT_LT(worst, 1e-5 * most);
    EXPECT_GT(beside, 20);
    EXPECT_EQ(lean, beside) << "it comes from the ball";
}

TEST_F(LookPasses, LightFromAllAroundIsThatOfSkyAndSkin)
{
    hair->light(light_from(kSixLights, kSky));
    for (const int level : {LOOK_FAR_FIELD, LOOK_DUAL_SCATTERING})
    {
        hair->bits(level);
        const oracle::Lit lit = hair->lit();
        const size_t count = oracle::voxels_of(lit.coarse);
        const std::vector<float> skin = hair->values<float>("bounced", 16 * count);
        double worst = 0.0, of_skin = 0.0;
        for (size_t at = 0; at < 16 * count; at += 4)
            for (size_t c = 0; c < 4; ++c)
            {
                const double left = double(lit.sky[at + (c == 3 ? 2 : level == LOOK_DUAL_SCATTERING ? c + 1 : 0)]);
                const double expected = c == 3 ? left : double(kSky[int(c)]) * left + double(skin[at + c]);
                worst = std::max(worst, std::abs(double(lit.around[at + c]) - expected));
                of_skin = std::max(of_skin, c == 3 ? 0.0 : double(skin[at + c]));
            }
        EXPECT_LT(worst, 1e-6) << "level " << level;
        EXPECT_GT(of_skin, 0.02);
    }
}

TEST_F(LookPasses, ColoursAreTheTwins)
{
    for (const int level : {LOOK_KARIS, LOOK_FAR_FIELD, LOOK_DUAL_SCATTERING})
    {
        const std::vector<glm::vec3> found = hair->colors(level);
        const oracle::Lit lit = hair->lit();
        double worst = 0.0, mean = 0.0;
        int compared = 0;
        for (int s = 0; s < volume.strands; s += 7)
            for (int k = 0; k < volume.places; ++k)
            {
                const Vec expected = oracle::shade(lit, &places[size_t(s * volume.places)], k, hair->looks[size_t(s)],
                                                   level - LOOK_KAJIYA_KAY);
                const glm::vec3 is = found[size_t(s * volume.places + k)];
                for (int c = 0; c < 3; ++c)
                {
                    worst = std::max(worst, std::abs(double(is[c]) - expected[c]) / (expected[c] + 1e-3));
                    mean += expected[c];
                    ++compared;
                }
            }
        // A half holds eleven bits: 5e-4. The rest is that of tau, whose coordinates are floats.
        EXPECT_LT(worst, 1.5e-3) << "level " << level;
        EXPECT_GT(mean / compared, 0.01);
    }
}

// Where segments are seen, the colours are those of all hair; whoever draws them reads one place beyond, too.
TEST_F(LookPasses, WhatIsNotSeenIsLeftOut)
{
    const std::vector<uint16_t> all_bits = hair->bits(LOOK_DUAL_SCATTERING);
    const cl::Buffer& colors = hair->shading.buffers().at("shaded");
    const size_t strands = size_t(volume.strands), count = size_t(volume.places);
    const size_t on_segment = (count - 1) / (kNodes - 2);
    std::vector<unsigned char> pieces(strands * kNodes, 0);
    Random random(3);
    for (size_t s = 0; s < strands; s += 2) // of every second strand a few
        for (size_t k = 1; k + 1 < kNodes; ++k)
            pieces[s * kNodes + k] = (unsigned char)(random.in(0.0, 1.0) < 0.2 ? 3 : 0);
    cl::Buffer on_device(test_device().context, CL_MEM_READ_WRITE, pieces.size());
    write(test_device(), on_device, pieces);
    constexpr uint16_t kUntouched = 0x7c01; // no number
    write(test_device(), colors, std::vector<uint16_t>(all_bits.size(), kUntouched));
    hair->shading.shade(kEye, LOOK_DUAL_SCATTERING, 1.0f, &on_device);
    const std::vector<uint16_t> found = read<uint16_t>(test_device(), colors, all_bits.size());
    size_t seen = 0, left_out = 0;
    for (size_t s = 0; s < strands; ++s)
        for (size_t place = 0; place < count; ++place)
        {
            bool read = false;
            for (size_t k = 1; k + 1 < kNodes; ++k)
                read |= pieces[s * kNodes + k] > 0 && place >= (k - 1) * on_segment && place <= k * on_segment + 1;
            const size_t i = 4 * (s * count + place);
            seen += read;
            left_out += found[i] == kUntouched;
            EXPECT_TRUE(!read || std::equal(&found[i], &found[i] + 3, &all_bits[i])) << s << ' ' << place;
            EXPECT_TRUE(s % 2 == 0 || found[i] == kUntouched) << s << ' ' << place;
        }
    EXPECT_GT(seen, 100u);
    EXPECT_GT(left_out, strands / 2 * count);
}

TEST_F(LookPasses, TheShareOfLightThatIsHandedOnIsTheTwins)
{
    const oracle::Lit lit = hair->lit();
    double straight = 0.0, handed = 0.0; // of a luminance of Rec. 709
    for (const float4& place : places)
        for (size_t i = 0; i < lit.rays.size(); ++i)
        {
            const Vec l = xyz(lit.rays[i].direction);
            const double tau = oracle::depth_at(&lit.depth[i * all], volume, lit.rays[i],
                                                oracle::in_voxels(xyz(place), volume) + double(OUT_TO_SUN) * l);
            const Vec e = xyz(lit.rays[i].irradiance) * Vec(0.2126, 0.7152, 0.0722);
            for (int c = 0; c < 3; ++c)
            {
                straight += e[c] * std::exp(-tau);
                handed += e[c] * (std::exp((lit.forward[c] - 1.0) * tau) - std::exp(-tau));
            }
        }
    const double expected = handed / (straight + handed);
    EXPECT_NEAR(hair->shading.handed_on_share(), expected, 1e-4 * expected);
    EXPECT_GT(expected, 0.02);
}

std::vector<LookSurface> random_surfaces(int count)
{
    Random random(8);
    std::vector<LookSurface> surfaces;
    for (int i = 0; i < count; ++i)
    {
        const glm::vec3 n(random.direction()), at = float(random.in(0.03, 0.25)) * n;
        surfaces.push_back(
            {F4(at.x, at.y, at.z, LIT_ABOVE), F4(n.x, n.y, n.z, float(i % 2)),
             F4(float(random.in(0, 1)), float(random.in(0, 1)), float(random.in(0, 1)), float(i / 2 % 2))});
    }
    return surfaces;
}

TEST_F(LookPasses, SolidThingsAreLitAsTheTwinSays)
{
    const std::vector<LookSurface> surfaces = random_surfaces(501);
    const std::vector<float4> found = hair->shading.lit(surfaces, kEye);
    const oracle::Lit lit = hair->lit();
    ASSERT_EQ(found.size(), surfaces.size());
    double worst = 0.0, mean = 0.0;
    for (size_t i = 0; i < surfaces.size(); ++i)
    {
        const Vec expected = oracle::lit_surface(lit, surfaces[i]), is = xyz(found[i]);
        for (int c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(is[c] - expected[c]) / (expected[c] + 0.01));
        mean += expected.x / double(surfaces.size());
    }
    EXPECT_LT(worst, 2e-4);
    EXPECT_GT(mean, 0.05);
}

// What tells the traced skin from it is that this one is not coupled with what lies under it.
TEST(Look, TheTracersGlossIsThatOfTheSkin)
{
    Hair bare(tangle(60, 1e-7f), plain_params(), false);
    const Vec sun = glm::normalize(Vec(0.3, 0.9, 0.4)), eye(kEye);
    bare.light(light_from({glm::vec3(sun)}, glm::vec3(0.0f)));
    std::vector<LookSurface> surfaces = random_surfaces(2000);
    for (LookSurface& s : surfaces)
    {
        s.normal.w = 1.0f;
        s.albedo = F4(0.0f, 0.0f, 0.0f, 0.0f);
    }
    const std::vector<float4> lit = bare.shading.lit(surfaces, kEye);
    const Vec irradiance = xyz(bare.lit().rays[0].irradiance);
    int shining = 0;
    for (size_t i = 0; i < surfaces.size(); ++i)
    {
        const Vec n = xyz(surfaces[i].normal), to_eye = glm::normalize(eye - xyz(surfaces[i].position));
        const Vec x = glm::normalize(glm::cross(Vec(0.3, 0.2, 0.9), n)), y = glm::cross(n, x);
        const auto turned = [&](const Vec& v) { return Vec(glm::dot(v, x), glm::dot(v, y), glm::dot(v, n)); };
        if (turned(to_eye).z < 0.01) // not seen
            continue;
        const double expected = irradiance.y * scatter({Vec(0.0), 1.0}, turned(to_eye), turned(sun)).y;
        EXPECT_NEAR(double(lit[i].y), expected, 1e-3 * expected + 1e-5);
        shining += expected > 0.01;
    }
    EXPECT_GT(shining, 20);
}

// The light along lines beside the straight edge of a capsule's shadow, on a plane behind it: as even as the edge is.
TEST(Look, AShadowsEdgeIsStraight)
{
    Hair bodies(tangle(60, 1e-7f));
    const Vec from(-0.08, 0.06, -0.06), axis(0.16, 0.03, 0.12), sun = glm::normalize(Vec(0.2, 0.9, -0.3));
    bodies.solver->set_colliders({{glm::vec3(from), 0.03f, false, {glm::vec3(from + axis)}}});
    bodies.solver->step({{Pose{}, 2.0 / 60.0, 1.0f / 60.0f}});
    bodies.light(light_from({glm::vec3(sun)}, glm::vec3(0.0f)));
    const Vec along = glm::normalize(axis), across = glm::normalize(glm::cross(sun, along));
    const Vec middle = from + 0.5 * axis - 0.06 * sun;
    const int lines = 81, points = 81;
    std::vector<LookSurface> surfaces;
    for (int o = 0; o < lines; ++o)
        for (int i = 0; i < points; ++i)
        {
            const Vec at = middle + (0.01 + 0.0005 * o) * across + 0.0005 * (i - points / 2) * along;
            surfaces.push_back({F4(float(at.x), float(at.y), float(at.z), LIT_ABOVE),
                                F4(float(sun.x), float(sun.y), float(sun.z), 0.0f), F4(1.0f, 1.0f, 1.0f, 0.0f)});
        }
    const std::vector<float4> lit = bodies.shading.lit(surfaces, kEye);
    double least = 1e9, most = 0.0, uneven = 0.0;
    for (int o = 0; o < lines; ++o)
    {
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < points; ++i)
        {
            const double value = lit[size_t(o * points + i)].y;
            sum += value / points;
            squares += value * value / points;
        }
        least = std::min(least, sum);
        most = std::max(most, sum);
        uneven = std::max(uneven, std::sqrt(std::max(0.0, squares - sum * sum)));
    }
    for (int o = 0; o < lines; o += 8)
        EXPECT_LT(least, 0.1 * most) << "all of the shadow's edge is seen";
    EXPECT_LT(uneven, 0.05 * most); // one point alone: 0.066
}

// ---- what must hold
// --------------------------------------------------------------------------------------------------

TEST(Look, AllWidthsFindTheSame)
{
    const Lighting lighting = light_from(kSixLights, kSky);
    Hair wide(tangle(60), plain_params(), true, with_width(16));
    wide.light(lighting);
    const std::vector<uint16_t> wide_bits = wide.bits(LOOK_DUAL_SCATTERING);
    const std::vector<float4> wide_lit = wide.shading.lit(random_surfaces(40), kEye);
    const size_t count = wide.suns * oracle::voxels_of(wide.shading.volume());
    const std::vector<float> wide_depth = wide.values<float>("depth", count);
    EXPECT_GT(std::ranges::max(wide_depth), 3.0f);
    Device as_gpu = with_width(1);
    as_gpu.is_gpu = true; // one sum for all, by atomic additions
    for (const Device& device : {with_width(8), as_gpu})
    {
        const char* kind = device.is_gpu ? ", as a GPU" : "";
        Hair narrow(tangle(60), plain_params(), true, device);
        narrow.light(lighting);
        const std::vector<float> depth = narrow.values<float>("depth", count);
        double worst = 0.0;
        for (size_t i = 0; i < count; ++i)
            worst = std::max(worst, double(std::abs(depth[i] - wide_depth[i])));
        EXPECT_LT(worst, 1e-6 * 60.0) << device.width << kind; // bodies are so deep
        const std::vector<float4> lit = narrow.shading.lit(random_surfaces(40), kEye);
        for (size_t i = 0; i < lit.size(); ++i)
            EXPECT_LT(glm::distance(xyz(lit[i]), xyz(wide_lit[i])), 1e-6) << device.width << kind << ' ' << i;
        const std::vector<uint16_t> bits = narrow.bits(LOOK_DUAL_SCATTERING);
        ASSERT_EQ(bits.size(), wide_bits.size());
        int apart = 0, far = 0; // a part in a million moves one in a thousand halves over its rounding
        for (size_t i = 0; i < bits.size(); ++i)
        {
            apart += bits[i] != wide_bits[i];
            far += std::abs(int(bits[i]) - int(wide_bits[i])) > 1;
        }
        EXPECT_LT(apart, int(bits.size()) / 100) << device.width << kind;
        EXPECT_EQ(far, 0) << device.width << kind;
    }
}

TEST(Look, EqualInputGivesEqualBytesAndNothingIsWrittenOutside)
{
    Device guarded = test_device();
    guarded.guards = std::make_shared<Guards>();
    const Lighting lighting = light_from(kSixLights, kSky);
    Hair first(tangle(45), plain_params(), true), second(tangle(45), plain_params(), true, guarded);
    first.light(lighting);
    second.light(lighting);
    for (const int level : {LOOK_KARIS, LOOK_DUAL_SCATTERING})
    {
        const std::vector<uint16_t> once = first.bits(level);
        EXPECT_TRUE(once == second.bits(level));
        first.light(light_from({{0.0f, -1.0f, 0.0f}}));
        first.light(lighting);
        EXPECT_TRUE(once == first.bits(level)) << "whatever came in between";
    }
    second.shading.lit(random_surfaces(17), kEye);
    EXPECT_GT(second.shading.handed_on_share(), 0.0);
    EXPECT_EQ(find_trespasses(guarded), std::vector<std::string>());
}

// Straight strands along x, side by side: what lies under them has their width times their length over it.
TEST(Look, ASlabShadesByItsFibres)
{
    std::vector<Tress> tresses;
    constexpr float kThick = 0.04f, kWide = 0.2f, kApart = 0.0016f, kFibre = 0.00006f; // m
    for (float y = 0.5f * kApart; y < kThick; y += kApart)
        for (float z = -0.5f * kWide + 0.5f * kApart; z < 0.5f * kWide; z += kApart)
        {
            Tress t;
            for (int k = 0; k < kNodes; ++k)
                t.nodes.emplace_back(kWide * (float(k - 1) / float(kNodes - 2) - 0.5f), y, z);
            t.width = kFibre;
            tresses.push_back(t);
        }
    HairParams params = plain_params();
    params.look_volume = 30;
    Hair hair(tresses, params);
    hair.light(light_from({{0.0f, 1.0f, 0.0f}, {0.0f, 1.0f, 0.5f}, {0.8f, 1.0f, 0.0f}}));
    const double through = double(kThick) / kApart * double(kFibre) / kApart; // crossings, straight down
    const double lean = std::sqrt(1.25);
    // Across the fibres, a slanted way is longer; along them, as much longer as they turn less to it.
    const double expected[] = {through, through * lean, through};
    // A little further down than the hair reaches, in its middle. From point to point it ripples by 7 %: voxels are 2.7
    // times as wide as the strands are apart.
    const oracle::Lit lit = hair.lit();
    const size_t all = oracle::voxels_of(lit.volume);
    for (size_t i = 0; i < 3; ++i)
    {
        double sum = 0.0, worst = 0.0;
        for (int k = 0; k < 400; ++k)
        {
            const Vec at(0.003 * (k % 20 - 9.5), -0.006, 0.003 * (k / 20 - 9.5));
            const double tau =
                oracle::depth_at(&lit.depth[i * all], lit.volume, lit.rays[i], oracle::in_voxels(at, lit.volume));
            sum += tau / 400;
            worst = std::max(worst, std::abs(tau / expected[i] - 1.0));
        }
        EXPECT_NEAR(sum, expected[i], 0.02 * expected[i]) << "light " << i;
        EXPECT_LT(worst, 0.09) << "light " << i;
    }
}

// What reaches the eye of white fur in a white surrounding is almost all of it.
TEST(Look, AWhiteCoatInAWhiteSkyIsWhite)
{
    Random random(9);
    std::vector<Tress> coat;
    for (int s = 0; s < 4000; ++s)
    {
        Tress t;
        const glm::dvec3 out = random.direction(), lean = glm::normalize(out + 0.3 * random.direction());
        for (int k = 0; k < kNodes; ++k)
            t.nodes.emplace_back(0.08 * out + 0.05 * double(k - 1) / (kNodes - 2) * lean);
        t.root = t.tip = glm::vec3(1.0f);
        t.width = 0.0012f;
        coat.push_back(t);
    }
    Hair hair(coat);
    const glm::vec3 eye(0.0f, 0.0f, 1.5f);
    Lighting lighting = light_from({{0.0f, 0.0f, 1.0f}}, glm::vec3(1.0f));
    lighting.suns[0].irradiance = glm::vec3(0.0f); // it tells how much lies before the eye
    hair.light(lighting);
    const std::vector<glm::vec3> colors = hair.colors(LOOK_DUAL_SCATTERING, eye);
    const std::vector<float4> places = hair.values<float4>("places", hair.places());
    const oracle::Lit lit = hair.lit();
    std::vector<float> seen;
    for (size_t i = 0; i < places.size(); ++i)
        if (oracle::depth_at(lit.depth.data(), lit.volume, lit.rays[0],
                             oracle::in_voxels(xyz(places[i]), lit.volume) + Vec(0.0, 0.0, 0.5)) < 0.7)
            seen.push_back(colors[i].y);
    ASSERT_GT(seen.size(), 1000u);
    std::ranges::sort(seen);
    const float bright = seen[seen.size() * 95 / 100], median = seen[seen.size() / 2];
    EXPECT_GT(bright, 0.84f);
    EXPECT_LT(bright, 1.02f);
    EXPECT_GT(median, 0.65f);
}

// Skin that keeps nothing back adds to it, and makes no light of its own.
TEST(Look, WhiteSkinUnderAWhiteCoatMakesNoLight)
{
    const auto coat = [](int strands)
    {
        Random random(9);
        std::vector<Tress> tresses;
        for (int s = 0; s < strands; ++s)
        {
            Tress t;
            const glm::dvec3 out = random.direction();
            for (int k = 0; k < kNodes; ++k)
                t.nodes.emplace_back((0.08 + 0.03 * double(k - 1) / (kNodes - 2)) * out);
            t.root = t.tip = glm::vec3(1.0f);
            t.width = 0.0008f;
            tresses.push_back(t);
        }
        return tresses;
    };
    for (const int strands : {300, 4000})
    {
        Hair hair(coat(strands));
        hair.solver->set_colliders({{glm::vec3(0.0f), 0.08f}});
        hair.solver->step({{Pose{}, 2.0 / 60.0, 1.0f / 60.0f}});
        const auto light_of = [&](float albedo)
        {
            hair.skin = skin_of_ball(glm::vec3(0.0f), 0.08f, glm::vec3(albedo), 2000);
            hair.light(light_from({}, glm::vec3(1.0f)));
            hair.bits(LOOK_DUAL_SCATTERING);
            const oracle::Lit lit = hair.lit();
            double most = 0.0, mean = 0.0;
            const std::vector<float4> places = hair.values<float4>("places", hair.places());
            for (const float4& p : places)
                for (const Vec& way : {Vec(1, 0, 0), Vec(0, 1, 0), Vec(0, 0, 1)})
                {
                    const oracle::TwoSides sides =
                        oracle::two_sides(lit.around, lit.coarse, xyz(p), Vec(0.0), 0.5 * way);
                    most = std::max({most, sides.front[1], sides.behind[1]});
                    mean += (sides.front[1] + sides.behind[1]) / double(6 * places.size());
                }
            return std::pair(most, mean);
        };
        const auto [most, mean] = light_of(1.0f);
        const auto [most_black, mean_black] = light_of(0.0f);
        EXPECT_LT(most, 1.15) << strands; // nothing seen from there is brighter than 1
        EXPECT_LT(mean, 1.0) << strands;
        EXPECT_GT(mean, mean_black + (strands < 1000 ? 0.15 : 0.05)) << strands;
    }
}

double mean_change(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b)
{
    double change = 0.0, whole = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
        change += double(std::abs(a[i].y - b[i].y)), whole += double(a[i].y);
    return change / whole;
}

TEST(Look, NothingFlickersAsLightOrCameraTurn)
{
    Hair hair(tangle(300, 0.001f));
    const auto turned = [](glm::vec3 v, double degrees)
    { return glm::vec3(glm::angleAxis(degrees * 0.017453292519943295, glm::dvec3(0, 1, 0)) * glm::dvec3(v)); };
    const glm::vec3 from(0.45f, 0.75f, 0.6f);
    for (const int level : {LOOK_FAR_FIELD, LOOK_DUAL_SCATTERING})
    {
        double most_light = 0.0, most_eye = 0.0;
        std::vector<glm::vec3> before;
        for (int degrees = 0; degrees <= 8; ++degrees)
        {
            hair.light(light_from({turned(from, 45.0 + degrees)}, kSky)); // past where the sweep changes its axis
            const std::vector<glm::vec3> now = hair.colors(level);
            if (degrees > 0)
                most_light = std::max(most_light, mean_change(before, now));
            before = now;
        }
        for (int degrees = 1; degrees <= 8; ++degrees)
        {
            const std::vector<glm::vec3> now = hair.colors(level, turned(kEye, degrees));
            most_eye = std::max(most_eye, mean_change(before, now));
            before = now;
        }
        EXPECT_LT(most_light, 0.03) << "level " << level;
        EXPECT_LT(most_eye, 0.03) << "level " << level;
    }
}

// A strand combed down over a ball, lit from where it is seen: the white highlight lies nearer the tip than the
// coloured one.
TEST(Look, TheWhiteHighlightLiesNearerTheTips)
{
    Tress t;
    for (int k = 0; k < kNodes; ++k)
    {
        const double down = (0.2 + 0.14 * double(k)) * 1.5707963267948966;
        t.nodes.emplace_back(0.0, 0.1 * std::cos(down), 0.1 * std::sin(down));
    }
    t.root = t.tip = {1.0f, 1.0f, 0.0f}; // what is blue was reflected at the surface
    t.width = 1e-5f;
    HairParams params = plain_params();
    params.look_roughness = 0.2f;
    Hair hair({t}, params);
    hair.light(light_from({{0.0f, 0.0f, 1.0f}}));
    const std::vector<glm::vec3> colors = hair.colors(LOOK_FAR_FIELD, {0.0f, 0.0f, 100.0f});
    size_t white = 0, colored = 0;
    const auto inside = [&](size_t i) { return colors[i].x / 2.0f - colors[i].z / 1.5f; };
    for (size_t i = 1; i + 1 < colors.size(); ++i)
    {
        white = colors[i].z > colors[white].z ? i : white;
        colored = inside(i) > inside(colored) ? i : colored;
    }
    const std::vector<float4> places = hair.values<float4>("places", hair.places());
    const auto down = [&](size_t i) { return std::atan2(places[i].z, places[i].y) * 57.29577951308232; };
    // Where twice the strand's inclination is -4 and 8 degrees: two degrees behind the normal, and four before it.
    EXPECT_NEAR(down(white), 92.0, 6.5); // places are 6 degrees apart
    EXPECT_LT(down(colored) + 3.0, down(white));
}

TEST(Look, HostileHairIsNoNumberNowhere)
{
    const float nan = std::nanf("");
    std::vector<Tress> tresses = tangle(20);
    tresses[3].nodes[5] = glm::vec3(nan);
    tresses[4].nodes.assign(kNodes, glm::vec3(0.1f, 0.0f, 0.0f)); // without any length
    tresses[5].nodes[7] = glm::vec3(1e30f, 0.0f, -1e30f);
    tresses[6].nodes[2] = glm::vec3(INFINITY, 0.0f, 0.0f);
    for (int k = 0; k < kNodes; ++k)
        tresses[7].nodes[size_t(k)] = glm::vec3(0.0f, 0.02f * float(k), 0.0f); // along the first light
    tresses[8].width = 0.0f;
    tresses[9].opacity = 0.0f;
    tresses[10].width = 1.0f;
    for (const float roughness : {0.0f, 1.0f})
        for (const float ior : {1.05f, 3.0f})
        {
            HairParams params = plain_params();
            params.look_roughness = params.look_azimuthal_roughness = roughness;
            params.look_ior = ior;
            Hair hair(tresses, params, true);
            hair.light(light_from(kSixLights, kSky));
            for (const int level : {LOOK_KARIS, LOOK_FAR_FIELD, LOOK_DUAL_SCATTERING})
                for (const glm::vec3& eye : {kEye, glm::vec3(0.0f, 0.1f, 0.0f), glm::vec3(0.0f, 1e4f, 0.0f)})
                {
                    const std::vector<glm::vec3> colors = hair.colors(level, eye);
                    const size_t each = size_t(hair.shading.volume().places);
                    for (size_t i = 0; i < colors.size(); ++i)
                        for (int c = 0; c < 3; ++c)
                            if (i / each != 3 && i / each != 5 && i / each != 6)
                            {
                                ASSERT_GE(colors[i][c], 0.0f);
                                ASSERT_LT(colors[i][c], 65000.0f) << "strand " << i / each << ", level " << level;
                            }
                }
            for (const float value : hair.lit().depth)
                ASSERT_TRUE(std::isfinite(value));
            for (const float value : hair.lit().sky)
                ASSERT_TRUE(std::isfinite(value));
            for (const float4& c : hair.shading.lit(random_surfaces(40), glm::vec3(0.0f)))
                ASSERT_TRUE(std::isfinite(c.x + c.y + c.z));
        }
}

TEST(Look, NoHairNoSunAndNoLightAreNoError)
{
    Device as_gpu = with_width(1);
    as_gpu.is_gpu = true;
    for (const Device& device : {test_device(), as_gpu})
        for (int strands = 0; strands < (device.is_gpu ? 1 : 2); ++strands)
        {
            Hair hair(tangle(strands), plain_params(), false, device);
            hair.light(light_from({}, kSky));
            for (const glm::vec3& color : hair.colors(LOOK_DUAL_SCATTERING))
                EXPECT_GT(color.x, 0.0f);
            EXPECT_GT(hair.shading.lit(random_surfaces(3), kEye)[0].x, 0.0f);
            EXPECT_EQ(hair.shading.handed_on_share(), 0.0);
            hair.light({});
            for (const glm::vec3& color : hair.colors(LOOK_DUAL_SCATTERING))
                EXPECT_EQ(color, glm::vec3(0.0f));
            EXPECT_EQ(hair.shading.lit(random_surfaces(3), kEye)[0].x, 0.0f);
            hair.light(light_from({{0.0f, 1.0f, 0.0f}}));
            EXPECT_EQ(hair.colors(LOOK_KARIS).size(), hair.places());
        }
}

TEST(Look, AutoTakesTheCheapestLevelWithinTheTolerance)
{
    const std::vector<LevelError> errors = {{LOOK_KARIS, 0.2}, {LOOK_FAR_FIELD, 0.1}, {LOOK_DUAL_SCATTERING, 0.0}};
    HairParams params;
    params.look_level = LOOK_AUTO;
    for (const auto& [percent, level] : {std::pair(30.0f, LOOK_KARIS), std::pair(15.0f, LOOK_FAR_FIELD),
                                         std::pair(5.0f, LOOK_DUAL_SCATTERING), std::pair(0.0f, LOOK_DUAL_SCATTERING)})
    {
        params.look_tolerance = percent;
        EXPECT_EQ(chosen_level(params, errors), level) << percent;
    }
    params.look_level = LOOK_KARIS;
    EXPECT_EQ(chosen_level(params, errors), LOOK_KARIS) << "it is said";
}

} // namespace
} // namespace coif
