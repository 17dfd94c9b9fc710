// Picture error: what each knob that makes pictures cheaper costs in likeness. The reference has every strand
// simulated, 30 subdivisions and 16 times the samples; from it one knob at a time is turned down, and last all of them
// are, as the style has them. Likeness is SSIM over the pixels that show hair in either picture: the backdrop and the
// face are alike whatever the hair does, and over a whole frame they alone would score well.
#include "app/measure/geodesic.h"
#include "app/measure/measure.h"
#include "app/renderer.h"
#include "app/shading.h"
#include "app/ssim.h"
#include "app/statistics.h"
#include "sim/error.h"
#include "sim/source.h"

#include <glm/geometric.hpp>

#include <chrono>
#include <cmath>
#include <memory>
#include <numeric>

namespace coif
{

namespace
{
// Close by, a strand that has moved by its own width is another strand to SSIM. From as many times further off, what
// counts is where the locks are and how dark they are.
constexpr int kAfar = 4;

struct Size
{
    int width, height, samples, strands;
};

// One way to make the picture.
struct Take
{
    std::string knob;
    double value;
    std::unique_ptr<Simulation> simulation;
    HairParams view; // parameters as the renderer gets them
    int samples;
    Image image = {};
    Mask hair = {};
};
} // namespace

static void step_and_draw(Simulation& simulation, int steps)
{
    for (int i = 0; i < steps; ++i)
    {
        simulation.step(simulation.hand());
        if (i % 16 == 0)
            simulation.solver().take_times(); // lets the queue's uploads go
    }
    simulation.solver().draw();
}

static Image picture_of(Renderer& renderer, const Take& take, const HairParams& view, int samples, const Size& size)
{
    FrameInput frame = frame_input(*take.simulation, camera_of(view));
    frame.params = view;
    frame.samples = samples;
    return renderer.picture(frame, size.width, size.height);
}

// The pixels that change when the hair turns from black to white: those where hair is seen, however little of it.
static Mask hair_in(Renderer& renderer, const Take& take, const Size& size)
{
    Image image[2];
    for (const int white : {0, 1})
    {
        HairParams view = take.view;
        view.head_scalp_tint = 0.0f;
        view.look_variation = 0.0f;
        view.look_root_color = view.look_tip_color = F4(float(white), float(white), float(white), 1.0f);
        image[white] = picture_of(renderer, take, view, std::min(take.samples, 4), size);
    }
    return changed_pixels(image[0], image[1], 8);
}

// Milliseconds of a step, its drawn strands and the picture.
static double take_ms(Renderer& renderer, const Take& take, const Size& size)
{
    Simulation& simulation = *take.simulation;
    simulation.solver().take_times();
    simulation.step(simulation.hand());
    simulation.solver().draw();
    const double ms = sum_of(simulation.solver().take_times());
    const auto begin = std::chrono::steady_clock::now();
    picture_of(renderer, take, take.view, take.samples, size);
    return ms + std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

// A style's hair as the scene asks for it: roots all over its scalp, nothing at random from guide to guide.
struct Subject
{
    Hairstyle style;
    Ball ball;
    std::vector<glm::vec3> roots;
    Groom own; // what the style itself grows
};

static Subject subject_of(const Measuring& with, const std::string& name, int strands)
{
    Subject subject{load_hairstyle(find_style(name)), {}, {}, {}};
    HairParams& p = subject.style.params;
    p.root_lift_variation = p.root_sweep_variation = 0.0f;
    p.look_level = LOOK_KAJIYA_KAY; // what is judged is the shape
    p.interpolation_strands = std::min(p.interpolation_strands, strands);
    const Simulation simulation(with.device, subject.style);
    const Scalp& scalp = simulation.assets().scalp;
    subject.ball = {scalp.center, scalp.radius};
    subject.own = simulation.solver().groom();
    for (const DrawnStrand& strand : subject.own.drawn)
        subject.roots.push_back(
            scalp.center +
            scalp.radius *
                glm::normalize(glm::vec3(strand.root.x, strand.root.y, strand.root.z) / p.head_scale - scalp.center));
    return subject;
}

// The style's own cuts and seeds, so that a strand is the same strand in every take.
static Groom with_seeds_of(Groom groom, const Groom& own)
{
    for (size_t i = 0; i < groom.drawn.size(); ++i)
    {
        groom.drawn[i].root.w = own.drawn[i].root.w;
        groom.drawn[i].seed = own.drawn[i].seed;
    }
    groom.extent = own.extent;
    groom.middle = own.middle;
    groom.farthest = own.farthest;
    return groom;
}

// Every `nth` strand.
static Groom thinned(Groom groom, int nth)
{
    std::vector<DrawnStrand> kept;
    for (size_t i = 0; i < groom.drawn.size(); i += size_t(nth))
        kept.push_back(groom.drawn[i]);
    groom.drawn = kept;
    groom.drawn_multi = int(kept.size());
    return groom;
}

static Take take_of(const Measuring& with, const Subject& subject, const std::string& knob, double value,
                    const Groom& groom, const HairParams& view, int samples, int steps)
{
    Hairstyle style = subject.style;
    style.params = view;
    Take take{knob, value, std::make_unique<Simulation>(with.device, style), view, samples};
    take.simulation->solver().set_groom(groom);
    take.simulation->reset();
    take.simulation->play(find_motion("shake"));
    step_and_draw(*take.simulation, steps);
    return take;
}

static std::vector<Row> likeness(const Measuring& with, Renderer& renderer, const std::string& name, const Size& size)
{
    const Subject subject = subject_of(with, name, size.strands);
    const Groom all = with_seeds_of(all_simulated(subject.style.params, subject.ball, subject.roots), subject.own);
    HairParams fine = subject.style.params;
    fine.smoothing_subdivisions = 30;
    const int steps = with.quick ? 30 : 48; // into the second half of a shake
    const auto made =
        [&](const std::string& knob, double value, const Groom& groom, const HairParams& view, int samples)
    {
        with.progress(fmt::format("{}, {} {}", name, knob, value));
        Take take = take_of(with, subject, knob, value, groom, view, samples, steps);
        take.image = picture_of(renderer, take, view, samples, size);
        take.hair = hair_in(renderer, take, size);
        return take;
    };

    const Take reference = made("reference", 0, all, fine, 16 * size.samples);
    std::vector<Take> takes;
    for (const int subdivisions : {1, 2, 3, 5, 10, 30})
    {
        HairParams view = fine;
        view.smoothing_subdivisions = subdivisions;
        takes.push_back(made("subdivisions", subdivisions, all, view, size.samples));
    }
    for (const int nth : {2, 4, 8, 16})
    {
        // As level of detail does it: fewer strands, each as wide as those that it stands for.
        HairParams view = fine;
        view.look_width *= float(nth);
        const Groom part = thinned(all, nth);
        takes.push_back(made("drawn strands", double(part.drawn.size()), part, view, size.samples));
    }
    for (const int frequency : with.quick ? std::vector<int>{3, 6, 12} : std::vector<int>{2, 3, 4, 6, 8, 12, 24})
    {
        const Groom groom = with_seeds_of(
            geodesic_groom(subject.style.params, subject.ball, subject.roots, frequency).groom, subject.own);
        takes.push_back(made("guides", groom.guides, groom, fine, size.samples));
    }
    for (int samples = 1; samples < size.samples; samples *= 2)
        takes.push_back(made("samples", samples, all, fine, samples));
    takes.push_back(made("as the style has it", 0, subject.own, subject.style.params, size.samples));

    with.progress(name + ", costs");
    std::vector<std::function<double()>> runs;
    for (const Take& take : takes)
        runs.push_back([&] { return take_ms(renderer, take, size); });
    const std::vector<double> ms = interleaved_medians(runs, with.quick ? 3 : 5);

    std::vector<Row> rows;
    for (size_t i = 0; i < takes.size(); ++i)
    {
        const Take& take = takes[i];
        Row row;
        row.scene = "picture";
        row.setting = name;
        row.solver = solver_name(take.view);
        row.knob = take.knob;
        row.value = take.knob == "as the style has it" ? NAN : take.value;
        row.at_least = true;
        row.ms = ms[i];
        row.reference = fmt::format("{} strands simulated, 30 subdivisions, {} samples", all.guides, reference.samples);
        row.unit = "SSIM";
        row.metric = "over hair";
        const Mask hair = either(take.hair, reference.hair);
        row.error = ssim(take.image, reference.image, hair);
        rows.push_back(row);
        row.metric = "over hair from afar";
        row.error = ssim(shrunk(take.image, kAfar), shrunk(reference.image, kAfar),
                         shrunk(hair, size.width, size.height, kAfar));
        rows.push_back(row);
        row.metric = "over the frame";
        row.error = ssim(take.image, reference.image);
        rows.push_back(row);
    }
    return rows;
}

std::vector<Row> measure_picture(const Measuring& with)
{
    const Window window(16, 16, Window::HIDDEN);
    Renderer renderer(data_folder() / "shaders");
    const Size size = with.quick ? Size{240, 240, 4, 1024} : Size{480, 480, 16, 4096};
    std::vector<Row> rows;
    for (const char* name : {"bob", "curly"})
    {
        if (with.quick && std::string(name) != "bob")
            continue;
        const std::vector<Row> more = likeness(with, renderer, name, size);
        rows.insert(rows.end(), more.begin(), more.end());
    }
    return rows;
}

} // namespace coif
