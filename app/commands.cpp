#include "app/commands.h"

#include "app/advise/advise.h"
#include "app/batch/batch.h"
#include "app/batch/results.h"
#include "app/bench/bench.h"
#include "app/editor.h"
#include "app/export.h"
#include "app/film.h"
#include "app/image.h"
#include "app/import.h"
#include "app/lab.h"
#include "app/measure/measure.h"
#include "app/morph.h"
#include "app/report.h"
#include "app/sequence.h"
#include "app/sheet.h"
#include "app/stress/stress.h"
#include "app/traced/shoot.h"
#include "sim/error.h"
#include "sim/exchange/place.h"
#include "sim/source.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace coif
{

static int run_check(const std::vector<std::string>& styles)
{
    int status = 0;
    for (const std::string& name : styles)
        try
        {
            if (name.empty())
                throw Error("check: a style without a name");
            Hairstyle style = load_hairstyle(find_style(name));
            Assets assets = load_assets(style);
            std::string doubt = doubtful_size(style.params, assets);
            if (assets.scalp.hair)
                for (const std::string& remark : assets.scalp.hair->remark)
                    doubt += (doubt.empty() ? "" : "; ") + remark;
            if (!style.host.ties.empty())
            {
                const std::string loose = doubtful_ties(style, grown(style, assets));
                doubt += (doubt.empty() || loose.empty() ? "" : "; ") + loose;
            }
            fmt::print("{}: good{}\n", name, doubt.empty() ? "" : ", but " + doubt);
        }
        catch (const Error& e)
        {
            fmt::print("{}\n", e.what());
            status = 1;
        }
    return status;
}

static int run_keys()
{
    const Hairstyle defaults;
    for (const ParamInfo& info : param_table())
    {
        std::string range;
        if (info.kind == Kind::CHOICE)
            range = fmt::format("{}", fmt::join(param_labels(info), " | "));
        else if (!info.on_host())
            range = fmt::format("[{}, {}]{}{}", info.min, info.max, *info.unit ? " " : "", info.unit);
        const std::string reader = only_reader(info);
        const bool varies = info.scope == Scope::STRAND && !info.on_host();
        fmt::print("{:<28} {:<13} {:<20} {:<28} {}{}{}\n", info.path(), kind_name(info.kind),
                   info.kind == Kind::LIST ? "" : value_text(defaults, info), range, info.help,
                   reader.empty() ? "" : fmt::format(" Read only where {}.", reader),
                   varies ? " May vary over the scalp." : "");
    }
    return 0;
}

static int run_save(const Options& options)
{
    Hairstyle style = load_style(options);
    load_assets(style); // refuses what could not be opened again
    save_hairstyle(style, options.output);
    fmt::print(stderr, "wrote {}\n", options.output);
    return 0;
}

static int run_import(const Options& options, const ImportOptions& wanted)
{
    std::string report;
    Hairstyle style = imported_style(options.style, options.output, wanted, report);
    load_assets(style); // refuses what could not be opened again
    save_hairstyle(style, options.output);
    fmt::print("{}", report);
    fmt::print(stderr, "wrote {}\n", options.output);
    return 0;
}

static int run_morph(const Options& options, const std::string& to, double at)
{
    if (!(at >= 0.0 && at <= 1.0))
        throw fail("--at {}: expected 0 (the first style) to 1 (the second)", at);
    Options second = options;
    second.style = to;
    Hairstyle style = morphed(load_style(options), load_style(second), at);
    load_assets(style); // refuses what could not be opened again
    save_hairstyle(style, options.output);
    fmt::print(stderr, "wrote {}\n", options.output);
    return 0;
}

static int run_shot(const Options& options, const ShotOptions& shot, const SequenceOptions& sequence,
                    std::optional<int> traced)
{
    if (traced && sequence.turntable != 0 && sequence.view < 0)
        throw fail("--traced {}: takes one picture; of a turntable, say which --view", *traced);
    if (sequence.wanted() && sequence.view < 0)
        return shoot_sequence(options, shot, sequence);
    if (!film_format(options.output).empty())
        throw fail("-o {}: a film is of many pictures; say --frames FIRST:LAST or --turntable VIEWS", options.output);
    const std::string ending = std::filesystem::path(options.output).extension().string();
    if (ending != ".png" && ending != ".hdr" && !ending.empty())
        throw fail("-o {}: is no name for a picture that coif writes: .png, or .hdr for light as it is",
                   options.output);
    const double turn = sequence.view < 0 ? 0.0 : frames_of(sequence, options.seconds)[0].turn;
    if (traced)
        return shoot_traced(options, shot, *traced, turn);
    check_folder(options.output);
    save_shot(options, shot, turn);
    fmt::print(stderr, "wrote {}\n", options.output);
    return 0;
}

// With more than one process each style is a task, as coif jobs would write it.
static int run_sheet(const Options& options, const ShotOptions& cell, const SheetOptions& wanted, int processes)
{
    if (wanted.levels && processes > 1)
        throw fail("-j {}: levels that are drawn at once disturb each other's cost; leave one of --levels and -j out",
                   processes);
    if (wanted.levels)
        return level_sheet(options, cell, wanted);
    if (processes == 1 || wanted.styles.size() == 1)
        return sheet(options, cell, wanted);
    std::optional<RunHere> done;
    const auto draw = [&](size_t i)
    {
        if (!done)
        {
            std::vector<std::string> lines;
            for (size_t k = 0; k < wanted.styles.size(); ++k)
            {
                Options one = options;
                one.style = wanted.styles[k];
                lines.push_back(shot_job(one, cell, fmt::format("{}.png", k)));
            }
            done.emplace(lines, processes);
        }
        std::string fault;
        const std::filesystem::path file = done->result(i, &fault);
        if (file.empty())
            throw Error(fault.starts_with("coif: ") ? fault.substr(6) : fault);
        return load_png(file);
    };
    return sheet(options, cell, wanted, draw);
}

static int run_edit(Options options)
{
    if (has_display())
        return edit(options);
    const std::string name = find_style(options.style).stem().string();
    std::error_code error;
    const bool taken = std::filesystem::exists(name + ".png", error);
    options.output = taken ? unused_name(name).string() : name + ".png";
    save_png(options.output, take_shot(options, {}));
    fmt::print(stderr, "coif: there is no display, so here is a picture instead: {}\n",
               std::filesystem::absolute(options.output).string());
    return 0;
}

// Throws Error where a task's style cannot be had; 300 styles of 60 frames are 18,000 lines, so each is looked at once.
static void look_at_style(const Options& options)
{
    static std::set<std::string> good;
    const std::string call = fmt::format("{}\n{}\n{}\n{}\n{}", options.style, options.variant, options.tolerance,
                                         options.random, fmt::join(options.sets, "\n"));
    if (!good.contains(call))
        load_style(options);
    good.insert(call);
}

// What -o of these commands may end in: a name of another kind is a slip, and the file that bears it may be dear.
static const std::map<std::string, std::vector<std::string>> kEndings = {
    {"save", {".toml"}},   {"import", {".toml"}}, {"morph", {".toml"}},
    {"advise", {".toml"}}, {"lab", {".csv"}},     {"report", {"", ".txt", ".log", ".md", ".csv", ".json"}}};

// Throws Error where -o names nothing, what the command does not write, or a file that it reads. `save` and `morph` may
// change the style that they are given.
static void check_output(std::vector<std::string> words, const std::string& style)
{
    std::optional<std::string> said;
    const bool in_place = words[0] == "save" || words[0] == "morph";
    const auto endings = kEndings.find(words[0]);
    words.erase(words.begin());
    for (size_t i = 0; i < words.size() && !said; ++i)
        if ((words[i] == "-o" || words[i] == "--output") && i + 1 < words.size())
        {
            said = words[i + 1];
            words.erase(words.begin() + long(i), words.begin() + long(i) + 2);
        }
        else if (const size_t skip = words[i].starts_with("--output=") ? 9 : words[i].starts_with("-o") ? 2 : 0; skip)
        {
            said = words[i].substr(skip);
            words.erase(words.begin() + long(i));
        }
    if (said && said->empty())
        throw Error("-o: names no file");
    if (!said)
        return;
    const std::string& output = *said;
    std::error_code error;
    if (std::filesystem::is_regular_file(output, error) &&
        !(in_place && std::filesystem::equivalent(find_style(style), output, error)))
        for (const NamedFile& read : named_files(words))
            if (std::filesystem::equivalent(read.file, output, error))
                throw fail("-o {}: the command reads this file, and would write over it; name another", output);
    const std::string ending = std::filesystem::path(output).extension().string();
    if (endings != kEndings.end() && std::ranges::find(endings->second, ending) == endings->second.end())
        throw fail("-o {}: coif {} writes no such file; let its name end in {}", output, endings->first,
                   endings->second.back());
}

// With `only_look` nothing is done: throws Error for what cannot be, where otherwise it is told and 2 is returned.
static int command(std::vector<std::string> words, bool only_look)
{
    const std::string version = "coif " COIF_VERSION;
    CLI::App app(version + ": write a hairstyle, see it live, shape it, take its picture.", "coif");
    app.set_help_all_flag("--help-all", "Help of every command");
    app.set_version_flag("--version", version);
    app.require_subcommand(0, 1);
    Options options;
    ShotOptions shot;
    ReportOptions wanted;
    std::string size = "1280x720";
    std::vector<std::string> styles;
    int processes = 1;

    const auto with_sets = [&](CLI::App* command)
    {
        command->add_option("--set", options.sets, "group.key=value, on top of the file; as often as wanted")
            ->allow_extra_args(false);
        command->add_option("--variant", options.variant, "The [variant.NAME] of the style that is to be on");
        command->add_option("--random", options.random, "The style that chance makes of it, by this number")
            ->check(CLI::Range(0, std::numeric_limits<int>::max()));
        command->add_option("--tolerance", options.tolerance,
                            "Error of the motion that is good enough, as 1%; coif chooses what the style leaves open");
    };
    const auto common = [&](CLI::App* command, bool style_needed)
    {
        CLI::Option* style = command->add_option("STYLE", options.style, "Hairstyle file, or the name of a preset");
        if (style_needed) // an unset variable of the shell is no wish for the default
            style->required()->check([](const std::string& name)
                                     { return name.empty() ? std::string("a style without a name") : std::string(); });
        with_sets(command);
        return command;
    };
    const auto with_device = [&](CLI::App* command)
    {
        command->add_option("--device", options.device, "cpu, gpu, or a part of an OpenCL device's name");
        return command;
    };
    CLI::App* edit_command = with_device(common(app.add_subcommand("edit", "Open the editor (the default)"), false));

    CLI::App* shot_command = with_device(common(app.add_subcommand("shot", "Draw a picture without a window"), true));
    shot_command
        ->add_option(
            "-o,--output", options.output,
            "PNG to write, or .hdr: light before any display transform; of many pictures also .mp4, .webm or .gif")
        ->required();
    shot_command->add_option("--size", size, "WIDTHxHEIGHT in pixels, up to 8192 each")->capture_default_str();
    const auto with_picture = [&](CLI::App* command)
    {
        command->add_option("--motion", options.motion, "Motion to play: a file, or one of coif's")
            ->capture_default_str();
        command->add_option("--camera", shot.camera, "front, left, right, back, top, or yaw,pitch[,distance] (deg, m)");
        command->add_option("--samples", shot.samples,
                            "Pictures averaged against jagged edges; 16, or 64 where lens or shutter blurs");
        return command->add_option("--time", options.seconds, "When to take it, s")->capture_default_str();
    };
    CLI::Option* shot_time = with_picture(shot_command);
    std::optional<int> traced;
    CLI::Option* shot_traced = shot_command->add_option(
        "--traced", traced, "A path-traced still of so many samples a pixel; more of them go on from where it ended");
    shot_command->add_flag("--transparent", shot.transparent, "No backdrop: alpha instead");
    SequenceOptions sequence;
    shot_command
        ->add_option("--frames", sequence.frames, "FIRST:LAST of the motion, both too: numbered pictures, X_%04d.png")
        ->excludes(shot_time)
        ->excludes(shot_traced);
    shot_command->add_option("--fps", sequence.fps, "Frames a second of --frames and of films")->capture_default_str();
    shot_command
        ->add_option("--turntable", sequence.turntable, "Views in a turn about the head, one a picture or a frame")
        ->check(CLI::Range(1, 1000000));
    shot_command->add_option("--view", sequence.view, "Only this view of --turntable, from 0: one picture")
        ->needs("--turntable")
        ->excludes("--frames");

    CLI::App* export_command =
        with_device(common(app.add_subcommand("export", "Write the hair as curves that other tools read"), true));
    ExportOptions exported;
    export_command
        ->add_option("-o,--output", options.output,
                     "File to write: .usda .abc .hair .tfx .obj .ply .glb .data .pbrt .mitsuba.txt")
        ->required();
    export_command->add_option("--for", exported.target,
                               "unreal, unity, blender, maya or houdini: axes, units and curves as it takes them");
    export_command->add_option("--strands", exported.strands, "drawn, or the guides under them")->capture_default_str();
    export_command->add_option("--points", exported.points,
                               "Points of a strand, at equal lengths; the default is its nodes");
    export_command->add_option("--curve", exported.curve, "linear or catmull_rom; the default is what the format has");
    export_command->add_option("--motion", options.motion, "Motion to play: a file, or one of coif's")
        ->capture_default_str();
    CLI::Option* export_time =
        export_command->add_option("--time", options.seconds, "When to take it, s")->capture_default_str();
    export_command
        ->add_option("--frames", sequence.frames, "FIRST:LAST of the motion, both too: a cache, .usda or .abc")
        ->excludes(export_time);
    export_command->add_option("--fps", sequence.fps, "Frames a second of --frames")->capture_default_str();

    CLI::App* sheet_command =
        with_device(app.add_subcommand("sheet", "Draw many styles into one picture, each with its name"));
    SheetOptions sheeted;
    std::string cell_size = "360x360";
    sheet_command->add_option("STYLE", sheeted.styles, "Hairstyle files, or names of presets")->required();
    with_sets(sheet_command);
    sheet_command->add_option("-o,--output", options.output, "PNG to write")->required();
    sheet_command->add_option("--size", cell_size, "WIDTHxHEIGHT of each style's picture, pixels")
        ->capture_default_str();
    sheet_command->add_option("--columns", sheeted.columns, "Styles in a row");
    sheet_command
        ->add_option("--levels", sheeted.levels,
                     "Each style at every level of the look, with its cost and its error against light that is traced, "
                     "with so many samples a pixel")
        ->check(CLI::Range(1, kMostTraced));
    const auto with_processes = [&](CLI::App* command, const char* what)
    { command->add_option("-j,--jobs", processes, what)->capture_default_str()->check(CLI::Range(1, 1024)); };
    with_processes(sheet_command, "Styles drawn at a time, each by a process of its own");
    with_picture(sheet_command);

    CLI::App* report_command =
        with_device(common(app.add_subcommand("report", "Play a motion and print health"), true));
    report_command->add_option("--motion", options.motion, "Motion to play: a file, or one of coif's")
        ->capture_default_str();
    report_command->add_option("--seconds", options.seconds, "How long, s")->capture_default_str();
    report_command->add_option("--fps", wanted.fps, "Frames a second that are looked at")->capture_default_str();
    report_command->add_option("--settle", wanted.settle, "Seconds at rest before the motion")->capture_default_str();
    report_command->add_flag("--json", wanted.json, "One JSON object");
    report_command->add_flag("--csv", wanted.csv, "One line a frame")->excludes("--json");
    report_command->add_flag("--row", wanted.row, "One line in all, with a head: what was set and the worst of it")
        ->excludes("--json")
        ->excludes("--csv");
    report_command->add_flag("--untimed", wanted.untimed, "No times in it, so that equal work gives equal bytes")
        ->needs("--row");
    report_command->add_option(
        "--traced", wanted.traced,
        "Samples a pixel of a small traced picture that the levels of the look are held against, "
        "for some seconds at most; 0 leaves it out");
    report_command->add_option("-o,--output", options.output, "File to write instead of the terminal");

    AdviseOptions advised;
    CLI::App* advise_command = with_device(common(
        app.add_subcommand("advise", "Say what a style could do without, what that saves, and what it lacks"), true));
    advise_command->get_option("--tolerance")
        ->description("Difference in motion that nobody would mind, of the hair's length: 3%, or what the style says");
    advise_command->add_option("--motion", advised.motion, "Motion to play: a file, or one of coif's")
        ->capture_default_str();
    advise_command->add_option("--seconds", advised.seconds, "How long, s")->capture_default_str();
    CLI::Option* apply = advise_command->add_flag("--apply", advised.apply, "Write the cheaper style: NAME.lean.toml");
    advise_command->add_option("-o,--output", options.output, "File that --apply writes instead")->needs(apply);
    advise_command->add_flag("--json", advised.json, "One JSON object");

    MeasureOptions measured;
    CLI::App* measure_command =
        with_device(app.add_subcommand("measure", "Measure accuracy against cost: tables and plots into a folder"));
    measure_command->add_flag("--quick", measured.quick,
                              "Fewer points: under a minute instead of half an hour and more");
    measure_command->add_option("--only", measured.only, "Scenes to run, separated by commas: A12,picture")
        ->delimiter(',');
    measure_command->add_flag_callback(
        "--look", [&] { measured.only.emplace_back("look"); },
        "Only the levels of the look against traced light, as --only look");
    with_processes(measure_command, "Scenes measured at a time, each by a process of its own; only with --untimed");
    measure_command->add_flag("--untimed", measured.untimed, "No prices in it, so that equal work gives equal bytes");
    measure_command->add_option(
        "-o,--output", options.output,
        "Folder to write into (default: measure), or a .csv: the rows alone, whatever they say");

    BenchOptions benched;
    CLI::App* bench_command = with_device(
        app.add_subcommand("bench", "Time every pass, against the machine's limits and the thesis' own way"));
    bench_command->add_flag("--quick", benched.quick, "Fewer repeats and sizes");
    bench_command->add_option("--only", benched.only, "Scenes to run, separated by commas: head,thesis")
        ->delimiter(',');
    CLI::Option* bench_json = bench_command->add_flag("--json", benched.json, "One JSON object instead of the table");
    bench_command->add_flag("--csv", benched.csv, "CSV instead of the table")->excludes(bench_json);
    bench_command->add_option("-o,--output", options.output, "Folder to write into (default: bench)");

    CLI::App* check_command = app.add_subcommand("check", "Validate hairstyle files and what they name");
    check_command->add_option("STYLE", styles, "Hairstyle files")->required();
    CLI::App* keys_command = app.add_subcommand("keys", "List everything a hairstyle can say");
    CLI::App* save_command = common(app.add_subcommand("save", "Change a hairstyle without a window"), true);
    save_command->add_option("-o,--output", options.output, "Hairstyle to write")->required();

    CLI::App* import_command = app.add_subcommand("import", "Make a style of the hair in another tool's file");
    ImportOptions imported;
    import_command
        ->add_option("FILE", options.style, "Alembic (.abc), .hair, USD text (.usda), TressFX (.tfx) or .data")
        ->required();
    import_command->add_option("-o,--output", options.output, "Hairstyle to write; it names FILE")->required();
    import_command->add_option("--up", imported.up, "The file's axis that points up: y, z, or unreal (z, left-handed)")
        ->check(CLI::IsMember({"y", "z", "unreal"}));
    import_command->add_option("--scale", imported.scale, "What the file's numbers count, m: 0.01 for centimetres");
    import_command->add_option("--scalp", imported.scalp, "OBJ that the roots are set onto, instead of coif's own");
    import_command->add_option("--set", imported.sets, "group.key=value; as often as wanted")->allow_extra_args(false);

    CLI::App* morph_command = app.add_subcommand("morph", "Make the style that lies between two");
    std::string morph_to;
    double morph_at = 0.5;
    morph_command->add_option("A", options.style, "Hairstyle file, or the name of a preset")->required();
    morph_command->add_option("B", morph_to, "The other")->required();
    morph_command->add_option("--at", morph_at, "0 is A, 1 is B; choices and files switch at 0.5")
        ->capture_default_str();
    with_sets(morph_command);
    morph_command->add_option("-o,--output", options.output, "Hairstyle to write")->required();

    LabOptions hung;
    CLI::App* lab_command =
        with_device(app.add_subcommand("lab", "Move one strand as its root is told, for comparing with references"));
    lab_command->add_option("--nodes", hung.strand.nodes, "Nodes, counting node 0, which is the root")
        ->capture_default_str();
    lab_command->add_option("--length", hung.strand.length, "From root to tip, m")->capture_default_str();
    lab_command->add_option("--drag", hung.drag, "Rate at which the air takes velocity away, 1/s")
        ->capture_default_str();
    lab_command->add_option("--tip-mass", hung.strand.tip_mass, "Mass of the last node against the others")
        ->capture_default_str();
    lab_command->add_option("--gamma", hung.gamma, "Droop number, clamped along the start direction; else no bending");
    lab_command->add_option("--angle", hung.strand.angle, "Of the straight start from straight down, towards +x, deg")
        ->capture_default_str();
    lab_command->add_option("--solver", hung.solver, "direct or pbd; the default is what styles have");
    lab_command->add_option("--fps", hung.fps, "Rows a second")->capture_default_str();
    lab_command->add_option("--root", hung.root, "CSV of t,x,y,z of node 0; a header line is allowed");
    CLI::Option* lab_seconds = lab_command->add_option("--seconds", options.seconds,
                                                       "How long, s; with --root: at most as long as that lasts");
    lab_command->add_option("--set", options.sets, "group.key=value of solver and forces")->allow_extra_args(false);
    lab_command->add_option("-o,--output", options.output, "CSV to write instead of the terminal");

    StressOptions strained;
    CLI::App* stress_command = with_device(app.add_subcommand("stress", "Play the solvers' extremes"));
    with_processes(stress_command, "Processes that play the random styles");
    stress_command->add_flag("--quick", strained.quick, "Less of everything: under a minute");
    stress_command->add_option("--only", strained.only, "Cases, by name")->delimiter(',');
    stress_command->add_option("--cases", strained.styles, "Random styles and motions");
    stress_command->add_option("--from", strained.from, "Number of the first random style")->capture_default_str();
    stress_command->add_option("--seed", strained.seed, "Of what is random")->capture_default_str();
    stress_command->add_option("--seconds", strained.soak, "Of the soak, simulated s");
    stress_command->add_flag("--untimed", strained.untimed, "No times in it, so that equal work gives equal bytes");
    stress_command->add_option("-o,--output", options.output,
                               "Folder for tables, map and what failed (stress), or a .csv: the rows alone, whatever "
                               "they say");

    const std::shared_ptr<Batch> batch = add_batch(app);

    // `coif STYLE` opens the editor too: a first word that is no command and no option is a style.
    bool is_command =
        !words.empty() && !words[0].starts_with("-h") && !words[0].starts_with("--help") && words[0] != "--version";
    for (const CLI::App* command : app.get_subcommands({}))
        is_command = is_command && words[0] != command->get_name();
    if (words.empty() || is_command)
        words.insert(words.begin(), "edit");
    const std::string command_name = words[0];
    const std::vector<std::string> said = words;
    try
    {
        std::reverse(words.begin(), words.end()); // as CLI11 takes them
        app.parse(words);
    }
    catch (const CLI::Success& e)
    {
        if (only_look)
            throw Error("asks for help or the version, which is no task");
        return app.exit(e);
    }
    catch (const CLI::ParseError& e)
    {
        if (only_look)
            throw fail("{}; coif {} --help lists what it takes", e.what(), command_name);
        app.exit(e);
        return 2;
    }
    parse_size(sheet_command->parsed() ? cell_size : size, shot);
    strained.jobs = measured.jobs = processes;
    if (only_look)
    {
        if (!options.style.empty())
            look_at_style(options);
        for (const std::string& style : sheeted.styles)
            find_style(style);
        return 0;
    }
    check_output(said, options.style);
    if (is_batch(*batch))
        return run_batch(*batch, [](const std::vector<std::string>& line) { command(line, true); });
    if (shot_command->parsed())
        return run_shot(options, shot, sequence, traced);
    if (export_command->parsed())
        return export_style(options, exported, sequence);
    if (sheet_command->parsed())
        return run_sheet(options, shot, sheeted, processes);
    if (report_command->parsed())
        return report(options, wanted);
    if (lab_command->parsed())
        return lab(options, hung, lab_seconds->count() > 0);
    if (advise_command->parsed())
        return advise(options, advised);
    if (measure_command->parsed())
        return measure(options, measured);
    if (bench_command->parsed())
        return bench(options, benched);
    if (stress_command->parsed())
        return run_stress(options, strained);
    if (check_command->parsed())
        return run_check(styles);
    if (keys_command->parsed())
        return run_keys();
    if (save_command->parsed())
        return run_save(options);
    if (import_command->parsed())
        return run_import(options, imported);
    if (morph_command->parsed())
        return run_morph(options, morph_to, morph_at);
    (void)edit_command;
    return run_edit(options);
}

int run_command(int argc, char** argv) { return command({argv + 1, argv + argc}, false); }

} // namespace coif
