#include "app/display.h"
#include "app/lens.h"
#include "app/look_error.h"
#include "app/look_level.h"
#include "app/progress.h"
#include "app/sheet.h"
#include "sim/error.h"
#include "sim/source.h"

namespace coif
{

static constexpr int kPictures = LOOK_DUAL_SCATTERING + 1; // the levels, and traced

static void lay_over_page(Image& image)
{
    const unsigned char page[3] = {kPage.r, kPage.g, kPage.b};
    for (size_t i = 0; i < image.pixels.size(); i += 4)
    {
        const int alpha = image.pixels[i + 3];
        for (size_t c = 0; c < 3; ++c)
            image.pixels[i + c] =
                static_cast<unsigned char>((image.pixels[i + c] * alpha + page[c] * (255 - alpha) + 127) / 255);
        image.pixels[i + 3] = 255;
    }
}

static std::string caption(int level, const LevelCost& cost, const Likeness& like)
{
    const std::string ms = level == LOOK_KAJIYA_KAY ? "" : fmt::format(", {:.0f} ms", cost.ms());
    const std::string off =
        std::isnan(like.roughly) ? "no lit hair" : fmt::format("{:.0f} % off", 100.0 * like.roughly);
    return fmt::format("{}\n{}{}", level_name(level), off, ms);
}

// The pictures of one style, from `first` on.
static void put_levels(Image& page, const SheetLayout& at, int first, Simulation& simulation, Renderer& renderer,
                       const ShotOptions& cell, int traced, const Progress& progress)
{
    const Camera camera = shot_camera(simulation, cell, 0.0);
    const SmallPicture small = {cell.width, cell.height, cell.samples.value_or(good_samples(simulation.params()))};
    HairParams shown = simulation.params();
    shown.look_level = LOOK_DUAL_SCATTERING; // all through one display transform
    simulation.solver().draw();
    const Tracer tracer(truth_scene(simulation, camera));
    TruthLimits limits;
    limits.samples = traced;
    limits.seconds = INFINITY;
    const LookTruth truth = look_truth(tracer, small, limits);

    const LitScene scene = lit_scene(simulation);
    const glm::vec3 eye(camera.position() - simulation.solver().head().origin);
    Shading shading(simulation.solver().device());
    const auto put = [&](int i, const LinearImage& light, const std::string& label)
    {
        Image image = displayed(light, shown);
        lay_over_page(image);
        put_cell(page, at, first + i, &image, label);
    };
    for (int level = LOOK_KAJIYA_KAY; level <= LOOK_DUAL_SCATTERING; ++level)
    {
        progress.say(fmt::format("{}: {}", simulation.style().name(), level_name(level)));
        const LinearImage light = light_at_level(renderer, simulation, camera, level, small);
        const std::string said =
            caption(level, cost_of_level(shading, scene, eye, level), likeness(light, truth.light, truth.hair, shown));
        put(level - 1, light, level == LOOK_KAJIYA_KAY ? simulation.style().name() + ", " + said : said);
    }
    put(kPictures - 1, truth.light, fmt::format("traced\n{} samples", truth.samples));
}

int level_sheet(const Options& options, const ShotOptions& cell, const SheetOptions& wanted)
{
    check_shot(options, cell);
    const int styles = int(wanted.styles.size());
    const int columns = wanted.columns.value_or((styles + 7) / 8);
    const SheetLayout at = lay_out(styles * kPictures, std::max(columns, 0) * kPictures, cell.width, cell.height, 2);
    check_folder(options.output);
    const Motion motion = find_motion(options.motion);
    const Window window(16, 16, Window::HIDDEN);
    const Device device = shared_with_gl(open_device(options));
    const Progress progress;
    Image page = empty_sheet(at);
    for (int i = 0; i < styles; ++i)
    {
        Options one = options;
        one.style = wanted.styles[size_t(i)];
        const Hairstyle style = load_style(one);
        progress.say(style.name() + ": falls to rest");
        Simulation simulation(device, style);
        simulation.play(motion);
        play_to(simulation, cell, options.seconds);
        Renderer renderer(data_folder() / "shaders");
        put_levels(page, at, i * kPictures, simulation, renderer, cell, *wanted.levels, progress);
    }
    progress.clear();
    save_png(options.output, page);
    fmt::print(stderr, "wrote {}: {} styles at {} levels\n", options.output, styles, kPictures - 1);
    return 0;
}

} // namespace coif
