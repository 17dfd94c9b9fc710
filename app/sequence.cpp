#include "app/sequence.h"

#include "app/film.h"
#include "app/progress.h"
#include "sim/error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

namespace coif
{

namespace fs = std::filesystem;

static constexpr int kMostFrames = 100000, kMostViews = 3600;

std::vector<Frame> frames_of(const SequenceOptions& wanted, double time)
{
    if (!(wanted.fps >= 1.0 && wanted.fps <= 1000.0))
        throw fail("--fps {}: expected 1 to 1000", wanted.fps);
    if (wanted.turntable < 0 || wanted.turntable > kMostViews)
        throw fail("--turntable {}: expected 1 to {} views", wanted.turntable, kMostViews);
    if (wanted.view != -1 && (wanted.view < 0 || wanted.view >= wanted.turntable))
        throw fail("--view {}: expected 0 to {}", wanted.view, wanted.turntable - 1);
    int first = 0, last = wanted.turntable - 1;
    if (wanted.view >= 0)
        first = last = wanted.view;
    if (!wanted.frames.empty())
    {
        char end = 0;
        if (wanted.frames.size() > 20 || std::sscanf(wanted.frames.c_str(), "%d:%d%c", &first, &last, &end) != 2 ||
            first < 0 || last < first || last >= kMostFrames)
            throw fail("--frames {}: expected FIRST:LAST, from 0 to {} and in this order", wanted.frames,
                       kMostFrames - 1);
        if (double(last) / wanted.fps > kLongestShot)
            throw fail("--frames {}: at {} frames a second that ends after {:.0f} s; coif plays {} at most",
                       wanted.frames, wanted.fps, double(last) / wanted.fps, kLongestShot);
    }
    std::vector<Frame> frames;
    for (int number = first; number <= last; ++number)
    {
        const int view = wanted.view >= 0       ? wanted.view
                         : wanted.turntable > 0 ? (number - first) % wanted.turntable
                                                : 0;
        const double turn = view == 0 ? 0.0 : 2.0 * std::numbers::pi * view / wanted.turntable;
        frames.push_back({number, wanted.frames.empty() ? time : number / wanted.fps, turn});
    }
    return frames;
}

// Where the number stands in a pattern, and with how many digits; nowhere: npos.
static size_t find_number(const std::string& pattern, size_t& length, int& digits)
{
    const size_t at = pattern.find('%');
    digits = 0;
    length = 2;
    if (at == pattern.npos)
        return at;
    size_t end = at + 1;
    if (end + 1 < pattern.size() && pattern[end] == '0' && pattern[end + 1] >= '1' && pattern[end + 1] <= '9')
    {
        digits = pattern[end + 1] - '0';
        end += 2;
    }
    if (end >= pattern.size() || pattern[end] != 'd' || pattern.find('%', end) != pattern.npos)
        throw fail("-o {}: expected one number in it, as %04d or %d", pattern);
    length = end + 1 - at;
    return at;
}

std::string numbered_pattern(const std::string& output)
{
    size_t length = 0;
    int digits = 0;
    const fs::path file = output;
    if (find_number(output, length, digits) != output.npos)
    {
        if (file.filename().string().find('%') == std::string::npos)
            throw fail("-o {}: the number must be in the file's name, not in a folder's", output);
        return output;
    }
    return (file.parent_path() / file.stem()).string() + "_%04d" +
           (file.has_extension() ? file.extension().string() : ".png");
}

std::string numbered(const std::string& pattern, int number)
{
    size_t length = 0;
    int digits = 0;
    const size_t at = find_number(pattern, length, digits);
    return pattern.substr(0, at) + fmt::format("{:0{}}", number, digits) + pattern.substr(at + length);
}

fs::path unused_name(const std::string& name)
{
    const bool ended = name.ends_with(".png") || name.ends_with(".hdr");
    const std::string stem = ended ? name.substr(0, name.size() - 4) : name;
    const std::string ending = ended ? name.substr(name.size() - 4) : ".png";
    fs::path file;
    std::error_code error;
    for (int n = 1; file.empty() || fs::exists(file, error); ++n)
        file = fmt::format("{}-{:03}{}", stem, n, ending);
    return file;
}

int shoot_sequence(const Options& options, const ShotOptions& shot, const SequenceOptions& wanted)
{
    check_shot(options, shot);
    const std::vector<Frame> frames = frames_of(wanted, options.seconds);
    const fs::path output = options.output;
    const std::string format = film_format(output);
    if (format == "mp4" && shot.transparent)
        throw fail("-o {}: an mp4 has no alpha; take .webm or .gif, or pictures", options.output);
    if (!format.empty() && std::min(shot.width, shot.height) < 2)
        throw fail("--size {}x{}: a film needs two pixels each way", shot.width, shot.height);
    const std::string pattern =
        numbered_pattern(format.empty() ? options.output : fs::path(output).replace_extension(".png").string());
    check_folder(output);
    const Hairstyle style = load_style(options);
    const Motion motion = find_motion(options.motion);
    const bool film_wanted = !format.empty(), without = film_wanted && !has_ffmpeg();
    if (without)
        fmt::print(stderr,
                   "coif: {} needs ffmpeg, which is not installed (on Debian: apt-get install ffmpeg); "
                   "here are the pictures instead\n",
                   options.output);
    const Window window(16, 16, Window::HIDDEN);
    const Device device = shared_with_gl(open_device(options));
    Studio studio(device, style, motion, shot);
    std::optional<Film> film;
    if (film_wanted && !without)
        film.emplace(output, shot.width, shot.height, wanted.fps, shot.transparent);
    Progress progress;
    for (const Frame& frame : frames)
    {
        progress.say(fmt::format("picture {} of {}", &frame - frames.data() + 1, frames.size()));
        studio.play_to(frame.seconds);
        if (film)
            film->add(studio.picture(frame.turn));
        else
            studio.save(numbered(pattern, frame.number), frame.turn);
    }
    if (film)
        film->finish();
    progress.clear();
    if (film)
        fmt::print(stderr, "wrote {}: {} pictures, {:.3g} s\n", options.output, frames.size(),
                   double(frames.size()) / wanted.fps);
    else
        fmt::print(stderr, "wrote {} pictures, {} to {}\n", frames.size(), numbered(pattern, frames.front().number),
                   numbered(pattern, frames.back().number));
    return without ? 1 : 0;
}

} // namespace coif
