// The levels of the look against light that is followed through the same strands (app/traced), in the hair's pixels
// alone. How far two traced pictures with other random numbers are apart stands beside it; and so that errors that make
// up for each other show, two parts of the light over black skin: all of it, and what comes straight from the suns.
#include "app/display.h"
#include "app/likeness.h"
#include "app/look_error.h"
#include "app/measure/measure.h"
#include "app/renderer.h"
#include "app/shading.h"
#include "app/sheet.h"
#include "app/traced/accumulation.h"
#include "sim/distance_grid.h"
#include "sim/error.h"
#include "sim/light_file.h"
#include "sim/source.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>

namespace coif
{

namespace
{
struct Pigment
{
    const char* name;
    float eumelanin, pheomelanin;
    double locks; // SSIM that dual scattering is to reach
};
constexpr Pigment kPigments[] = {{"brown", 1.3f, 0.2f, 0.93},
                                 {"blond", 0.3f, 0.1f, 0.91},
                                 {"black", 8.0f, 0.0f, 0.90},
                                 {"red", 0.3f, 1.0f, 0.91},
                                 {"white", 0.01f, 0.0f, 0.85}};

// The constants of kernels/look.h were chosen on other styles, and under other lights.
constexpr const char* kStyles[] = {"long", "ringlets", "wolf_cut"};
constexpr const char* kLights[] = {"studio", "outdoors", "rim"};

constexpr int kAllBounces = TraceLimits{}.bounces;
constexpr double kRadiance = 0.15, kRoughly = 0.23; // what dual scattering may be off by, and over 6 pixels
} // namespace

// Traced anew, or as it was before for the same input.
static Accumulation traced(const Tracer& tracer, int width, int height, uint32_t samples, uint64_t seed,
                           int bounces = kAllBounces)
{
    const Hash hash = hash_of(tracer.scene());
    const std::filesystem::path folder = cache_folder();
    const std::string some = bounces == kAllBounces ? "" : fmt::format("-{}", bounces);
    const std::filesystem::path file = folder / fmt::format("traced-{:016x}{:016x}-{}x{}-{}{}.traced", hash.word[0],
                                                            hash.word[1], width, height, seed, some);
    Accumulation picture = empty_accumulation(width, height);
    if (std::optional<Record> before = folder.empty() ? std::nullopt : read_record(file))
        picture = std::move(before->picture);
    if (picture.fewest() < samples)
    {
        TraceLimits limits;
        limits.seed = seed;
        limits.bounces = bounces;
        tracer.trace(picture, samples, limits);
        if (!folder.empty())
        {
            make_folder(folder);
            write_record(file, hash, picture);
        }
    }
    return picture;
}

static void add_radiance(std::vector<Row>& rows, Row row, const Likeness& like, double pass)
{
    const char* channels[] = {"red", "green", "blue"};
    for (int c = 0; c < 3; ++c)
    {
        row.metric = fmt::format("radiance, {}", channels[c]);
        row.measured = like.radiance[c];
        row.error = std::abs(like.radiance[c] - 1.0);
        row.pass = pass;
        rows.push_back(row);
    }
}

static void add_rows(std::vector<Row>& rows, const Row& base, const Likeness& like, const Pigment* judged)
{
    add_radiance(rows, base, like, judged ? kRadiance : NAN);
    Row row = base;
    row.metric = "radiance, over 6 pixels";
    row.error = like.roughly;
    row.pass = judged ? kRoughly : NAN;
    rows.push_back(row);
    row.metric = "locks";
    row.unit = "SSIM";
    row.error = like.locks;
    row.at_least = true;
    row.pass = judged ? judged->locks : NAN;
    rows.push_back(row);
}

namespace
{
// A row for each pigment, with the levels and the traced picture side by side.
struct Comparison
{
    int columns = LOOK_DUAL_SCATTERING + 1;
    SheetLayout at;
    Image page;
    int cell = 0;

    Comparison(int pigments, int width, int height)
        : at(lay_out(columns * pigments, columns, width, height)), page(empty_sheet(at))
    {
    }
    void put(const LinearImage& light, const HairParams& params, const std::string& label)
    {
        const Image image = displayed(light, params);
        put_cell(page, at, cell++, &image, label);
    }
};
} // namespace

std::vector<Row> measure_look(const Measuring& with)
{
    const Window window(16, 16, Window::HIDDEN);
    Renderer renderer(data_folder() / "shaders");
    const int width = with.quick ? 120 : 160, height = with.quick ? 137 : 183, samples = with.quick ? 16 : 32;
    const SmallPicture small = {width, height, with.quick ? 4 : 16};
    const std::vector<std::string> levels = param_labels(*find_param("look.level"));
    std::vector<Row> rows;
    for (const char* name : std::span(kStyles).first(with.quick ? 1 : std::size(kStyles)))
    {
        Hairstyle style = load_hairstyle(find_style(name));
        Simulation simulation(with.device, style);
        simulation.solver().draw();
        Camera camera = camera_of(style.params);
        camera.distance = 0.8;
        for (const char* lights : std::span(kLights).first(with.quick ? 1 : std::size(kLights)))
        {
            set_own_lights(style,
                           load_lights(data_folder() / "hairstyles" / "lights" / fmt::format("{}.toml", lights)));
            const std::span pigments = std::span(kPigments).first(with.quick ? 2 : std::size(kPigments));
            Comparison sheet(int(pigments.size()), width, height);
            for (const Pigment& pigment : pigments)
            {
                const std::string setting = fmt::format("{}, {}, {}", name, pigment.name, lights);
                with.progress(setting);
                style.params.look_pigment = 1;
                style.params.look_eumelanin = pigment.eumelanin;
                style.params.look_pheomelanin = pigment.pheomelanin;
                simulation.set_style(style);
                simulation.solver().draw();
                const Tracer tracer(truth_scene(simulation, camera));
                const std::vector<float> hair = tracer.hair(width, height, 16);
                const LinearImage truth = mean_of(traced(tracer, width, height, uint32_t(samples), 0));
                const LinearImage again = mean_of(traced(tracer, width, height, uint32_t(samples), 1));
                HairParams shown = simulation.params();
                shown.look_level = LOOK_DUAL_SCATTERING; // all through one display transform

                Row row;
                row.scene = "look";
                row.setting = setting;
                row.solver = solver_name(style.params);
                row.reference = fmt::format("{} samples traced a pixel", samples);
                for (int level = LOOK_KAJIYA_KAY; level <= LOOK_DUAL_SCATTERING; ++level)
                {
                    const auto begin = std::chrono::steady_clock::now();
                    const LinearImage image = light_at_level(renderer, simulation, camera, level, small);
                    row.ms =
                        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
                    row.knob = levels[size_t(level)];
                    const bool judged = level == LOOK_DUAL_SCATTERING;
                    add_rows(rows, row, likeness(image, truth, hair, shown), judged ? &pigment : nullptr);
                    sheet.put(image, shown, fmt::format("{}, {}", pigment.name, row.knob));
                }
                sheet.put(truth, shown, fmt::format("{}, traced", pigment.name));
                row.knob = "traced again";
                row.ms = NAN;
                add_rows(rows, row, likeness(again, truth, hair, shown), nullptr);

                Hairstyle part = style;
                const auto add_part = [&](const char* knob, int level, int bounces)
                {
                    simulation.set_style(part);
                    simulation.solver().draw();
                    const Tracer of_part(truth_scene(simulation, camera));
                    const LinearImage image = light_at_level(renderer, simulation, camera, level, small);
                    row.knob = knob;
                    add_radiance(rows, row,
                                 likeness(image, mean_of(traced(of_part, width, height, uint32_t(samples), 0, bounces)),
                                          hair, shown),
                                 NAN);
                };
                part.params.head_color = F4(0.0f, 0.0f, 0.0f, 1.0f);
                part.params.head_scalp_tint = 0.0f;
                add_part("dual_scattering, black skin", LOOK_DUAL_SCATTERING, kAllBounces);
                part.params.look_sky_radiance = 0.0f;
                add_part("far_field, black skin, suns alone, one bounce", LOOK_FAR_FIELD, 0);
            }
            if (!with.folder.empty())
            {
                make_folder(with.folder / "look");
                save_png(with.folder / "look" / fmt::format("{}, {}.png", name, lights), sheet.page);
            }
        }
    }
    return rows;
}

} // namespace coif
