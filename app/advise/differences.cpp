#include "app/advise/differences.h"

#include "app/ssim.h"
#include "sim/error.h"
#include "sim/median.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>

namespace coif
{

namespace
{
// SSIM is taken from afar: close by, a strand that has moved by its own width is another strand to it. Of a picture
// this many times smaller, what counts is where the locks are and how dark they are; and it has as many samples a side.
constexpr int kAfar = 4;
constexpr int kLookEvery = 3;                   // frames
constexpr int kPictures = 2;                    // at the start and at the end
constexpr size_t kDrawnNodes = size_t(1) << 25; // of all styles side by side: a gigabyte

// One style in the play.
struct Player
{
    HairParams view;                        // as the renderer gets them
    std::shared_ptr<Simulation> simulation; // the unchanged style's own, where only what is seen differs
    Image image = {};                       // the last picture, from afar
    Mask hair = {};
    std::vector<double> step_ms = {}, picture_ms = {};
};
} // namespace

double apart(const float* a, int nodes_a, const float* b, int nodes_b, int guides)
{
    if (nodes_a > nodes_b)
        return apart(b, nodes_b, a, nodes_a, guides);
    double sum = 0.0;
    for (int s = 0; s < guides; ++s)
        for (int k = 2; k < nodes_a; ++k)
        {
            const double along = double(k - 1) * (nodes_b - 2) / (nodes_a - 2); // links from the root
            const int below = std::min(int(along), nodes_b - 3);
            const glm::dvec3 on_b =
                glm::mix(vector_at(b, s, 1 + below, nodes_b), vector_at(b, s, 2 + below, nodes_b), along - below);
            const glm::dvec3 away = vector_at(a, s, k, nodes_a) - on_b;
            sum += glm::dot(away, away);
        }
    return std::sqrt(sum / (double(guides) * (nodes_a - 2)));
}

static Player player_of(const Trial& trial, const Hairstyle& style)
{
    Player player{style.params, std::make_shared<Simulation>(trial.device, style)};
    player.simulation->play(trial.motion);
    return player;
}

static bool only_seen(const Hairstyle& a, const Hairstyle& b)
{
    return std::ranges::all_of(param_table(), [&](const ParamInfo& info)
                               { return info.effect == Effect::VIEW || same_value(a, b, info); });
}

// Frames of about 1/60 s that the steps of the style, and of one at half its rate, divide alike.
static double frame_seconds(const Simulation& simulation)
{
    const double rate = 1.0 / simulation.step_seconds();
    return simulation.step_seconds() * (rate >= 120.0 ? 2.0 * std::floor(rate / 120.0) : 1.0);
}

// A frame. One that is timed is never slept through: what is asked for is the price in motion.
static void move(Player& player, double seconds, bool timed)
{
    Simulation& simulation = *player.simulation;
    Solver& solver = simulation.solver();
    solver.take_times();
    if (timed)
        solver.keep_awake();
    simulation.advance(seconds, simulation.hand(), 1 << 20);
    if (!timed)
        return;
    solver.draw();
    player.step_ms.push_back(sum_of(solver.take_times()));
}

static FrameInput frame_of(const Player& player)
{
    Camera camera = camera_of(player.view);
    camera.target += player.simulation->jumped();
    FrameInput frame = frame_input(*player.simulation, camera);
    frame.params = player.view;
    return frame;
}

static Image picture_of(const Trial& trial, const FrameInput& frame)
{
    return trial.renderer.picture(frame, kPictureSize, kPictureSize);
}

// Where a picture differs from one of the bare head.
static Mask hair_in(const Image& image, const Image& bald)
{
    return shrunk(changed_pixels(image, bald, 8), kPictureSize, kPictureSize, kAfar);
}

static Image bald_picture(const Trial& trial, const Player& player)
{
    FrameInput frame = frame_of(player);
    frame.params.look_opacity = 0.0f;
    frame.params.head_scalp_tint = 0.0f;
    return picture_of(trial, frame);
}

// What a picture takes: of a software renderer the time of all processors, which other programs do not disturb; of a
// graphics card the time that passes.
static double picture_clock_ms()
{
    if (is_software_renderer())
        return 1e3 * double(std::clock()) / CLOCKS_PER_SEC;
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

static void take_picture(const Trial& trial, Player& player, const Image& bald)
{
    trial.renderer.picture(frame_of(player), 16, 16); // takes in the head, which is not the picture's price
    const double begin = picture_clock_ms();
    const Image image = picture_of(trial, frame_of(player));
    player.picture_ms.push_back(picture_clock_ms() - begin);
    player.hair = hair_in(image, bald);
    player.image = shrunk(image, kAfar);
}

static double unlike(const Player& player, const Image& image, const Mask& hair)
{
    const double likeness = ssim(player.image, image, either(player.hair, hair));
    return std::isnan(likeness) ? 0.0 : 1.0 - likeness; // no hair is seen at all
}

// The style with all its hair aside, which is what a camera aside sees.
static double unlike_itself(const Trial& trial, const Player& player, const Image& bald)
{
    FrameInput frame = frame_of(player);
    const double aside = trial.tolerance * double(player.simulation->solver().groom().longest);
    frame.camera.target += aside * glm::dvec3(std::cos(frame.camera.yaw), 0.0, -std::sin(frame.camera.yaw));
    const Image image = picture_of(trial, frame);
    return unlike(player, shrunk(image, kAfar), hair_in(image, bald));
}

// Of frame after frame, each against the same one.
static double saved(const std::vector<double>& own, const std::vector<double>& changed)
{
    std::vector<double> less;
    for (size_t i = 0; i < own.size() && i < changed.size(); ++i)
        less.push_back(own[i] - changed[i]);
    return median(less);
}

// Of the few pictures: nothing, unless all of the one are surely quicker than all of the other.
static double saved_surely(const std::vector<double>& own, const std::vector<double>& changed)
{
    const auto [least, most] = std::ranges::minmax(own);
    const auto [least_changed, most_changed] = std::ranges::minmax(changed);
    const double sure = 1.1;
    return sure * most < least_changed || sure * most_changed < least ? least - least_changed : 0.0;
}

// The first of the players is the style as it is.
static void play(const Trial& trial, std::vector<Player>& players, Comparison& comparison)
{
    const Simulation& own = *players[0].simulation;
    const Groom& groom = own.solver().groom();
    const double frame = frame_seconds(own);
    const long frames = std::max(1L, std::lround(trial.seconds / frame));
    std::vector<Difference> all(players.size());
    std::vector<double> squares(players.size());
    int looks = 0, pictures = 0;
    for (long f = 0; f <= frames; ++f)
    {
        const bool picture = f * (kPictures - 1) >= pictures * frames;
        const bool look = f > 0 && (f % kLookEvery == 0 || picture);
        for (Player& player : players)
        {
            const bool shared = &player != &players[0] && player.simulation == players[0].simulation;
            if (f > 0 && !shared)
                move(player, frame, look);
            else if (f == 0 && !shared)
                player.simulation->solver().draw();
        }
        if (look)
        {
            const Mapped here = own.solver().guide_positions();
            for (size_t i = 1; i < players.size(); ++i)
            {
                const Solver& solver = players[i].simulation->solver();
                squares[i] += std::pow(apart(here.as<float>(), groom.nodes, solver.guide_positions().as<float>(),
                                             solver.groom().nodes, groom.guides),
                                       2);
            }
            ++looks;
        }
        if (picture)
        {
            const Image bald = bald_picture(trial, players[0]);
            for (Player& player : players)
                take_picture(trial, player, bald);
            for (size_t i = 1; i < players.size(); ++i)
                all[i].picture = std::max(all[i].picture, unlike(players[0], players[i].image, players[i].hair));
            comparison.moved = std::max(comparison.moved, unlike_itself(trial, players[0], bald));
            ++pictures;
        }
    }
    comparison.step_ms = median(players[0].step_ms);
    comparison.picture_ms = std::ranges::min(players[0].picture_ms);
    for (size_t i = 1; i < players.size(); ++i)
    {
        all[i].motion = std::sqrt(squares[i] / looks) / double(groom.longest);
        if (players[i].simulation != players[0].simulation)
            all[i].step_ms = saved(players[0].step_ms, players[i].step_ms);
        if (comparison.step_ms > 0.0)
            all[i].share = all[i].step_ms / comparison.step_ms;
        all[i].picture_ms = saved_surely(players[0].picture_ms, players[i].picture_ms);
        comparison.changed.push_back(all[i]);
    }
}

Comparison compare(const Trial& trial, const Hairstyle& style, const std::vector<Hairstyle>& changed)
{
    const size_t own = size_t(style.params.interpolation_strands) * size_t(style.params.strand_nodes);
    const size_t together = std::max<size_t>(1, kDrawnNodes / std::max<size_t>(own, 1));
    Comparison comparison;
    for (size_t first = 0; first < changed.size(); first += together)
    {
        const size_t last = std::min(first + together, changed.size());
        trial.progress("letting the hair fall");
        std::vector<Player> players;
        players.push_back(player_of(trial, style));
        for (size_t i = first; i < last; ++i)
        {
            trial.progress(fmt::format("letting the hair fall, {} of {}", i + 1, changed.size()));
            players.push_back(only_seen(style, changed[i]) ? Player{changed[i].params, players[0].simulation}
                                                           : player_of(trial, changed[i]));
        }
        trial.progress(fmt::format("playing {}", trial.motion.name));
        play(trial, players, comparison);
    }
    return comparison;
}

} // namespace coif
