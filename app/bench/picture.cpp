// What drawing hair takes: by the rasteriser in OpenCL and by the geometry shader, as the thesis draws it. Its
// table 6.1 has 1024 to 8192 strands at 5 and 10 subdivisions.
#include "app/bench/hair.h"
#include "app/renderer.h"
#include "app/ssim.h"
#include "sim/source.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace coif
{

namespace
{
constexpr int kWidth = 1280, kHeight = 720;

// One way to draw; multisample as render.multisample lists it.
struct Way
{
    const char* name;
    Method method;
    int multisample;
    double least_ratio;
};
} // namespace

static Image picture_of(Renderer& renderer, const Simulation& simulation, const HairParams& view)
{
    FrameInput frame = frame_input(simulation, camera_of(view));
    frame.params = view;
    return renderer.picture(frame, kWidth, kHeight);
}

// Share of the picture that shows hair, however little of it.
static double covered(Renderer& renderer, const Simulation& simulation)
{
    Image image[2];
    for (const int white : {0, 1})
    {
        HairParams view = simulation.params();
        view.head_scalp_tint = view.look_variation = 0.0f;
        view.look_root_color = view.look_tip_color = F4(float(white), float(white), float(white), 1.0f);
        image[white] = picture_of(renderer, simulation, view);
    }
    const Mask hair = changed_pixels(image[0], image[1], 8);
    return double(std::count(hair.begin(), hair.end(), true)) / (kWidth * kHeight);
}

std::vector<BenchRow> bench_picture(const Benching& with)
{
    const Window window(16, 16, Window::HIDDEN);
    Renderer renderer(data_folder() / "shaders");
    constexpr int kOff = 1, kFour = 3;
    const Way ways[] = {{"geometry shader, 4x multisampling", BY_GEOMETRY, kFour, NAN},
                        {"geometry shader, coverage at edges", BY_GEOMETRY, kOff, 3.0},
                        {"rasteriser in OpenCL", BY_OPENCL, kOff, 5.0}};
    std::vector<BenchRow> rows;
    for (const int strands : {1024, 2048, 4096, 8192})
    {
        if (with.quick && strands != 4096)
            continue;
        with.progress(fmt::format("{} strands", strands));
        Options options;
        options.style = "long";
        options.sets = {fmt::format("interpolation.strands={}", strands), "camera.distance=0.5",
                        "look.level=kajiya_kay"}; // the thesis'
        Hairstyle style = load_style(options);
        style.host.partings.clear(); // of which each strand would keep its own colours
        Simulation simulation(with.device, style);
        simulation.solver().draw();
        const double share = covered(renderer, simulation);
        for (const int subdivisions : {5, 10})
        {
            std::vector<std::function<PassTimes()>> runs;
            for (const Way& way : ways)
                runs.push_back(
                    [&, way]
                    {
                        HairParams view = simulation.params();
                        view.smoothing_subdivisions = subdivisions;
                        view.render_method = way.method;
                        view.render_multisample = way.multisample;
                        const auto begin = std::chrono::steady_clock::now();
                        picture_of(renderer, simulation, view);
                        const std::chrono::duration<double, std::milli> passed =
                            std::chrono::steady_clock::now() - begin;
                        return PassTimes{{"picture", passed.count()}};
                    });
            const std::vector<std::vector<BenchRow>> times = timed(runs, with.quick ? 3 : 7);
            for (size_t i = 0; i < times.size(); ++i)
            {
                BenchRow row = times[i].front();
                row.what = ways[i].name;
                row.note = fmt::format("{} x {}, {} subdivisions, hair on {:.0f} %", kWidth, kHeight, subdivisions,
                                       100.0 * share);
                row.strands = strands;
                row.cores = with.machine.compute_units;
                row.baseline_ms = times[0].front().ms;
                if (strands == 4096 && subdivisions == 5)
                    row.least_ratio = ways[i].least_ratio;
                rows.push_back(row);
            }
        }
    }
    return rows;
}

} // namespace coif
