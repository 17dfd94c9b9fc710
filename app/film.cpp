#include "app/film.h"

#include "sim/error.h"

#include <cassert>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace coif
{

namespace fs = std::filesystem;

std::string film_format(const fs::path& file)
{
    for (const char* format : {"mp4", "webm", "gif"})
        if (file.extension() == std::string(".") + format)
            return format;
    return {};
}

bool has_ffmpeg()
{
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
    {
        const fs::path program = fs::path(folder.empty() ? "." : folder) / "ffmpeg";
        std::error_code error;
        if (fs::is_regular_file(program, error) && access(program.c_str(), X_OK) == 0)
            return true;
    }
    return false;
}

std::vector<std::string> film_command(const std::string& format, const fs::path& file, int width, int height,
                                      double fps, bool transparent)
{
    std::vector<std::string> words = {"ffmpeg", "-loglevel", "error", "-nostdin", "-y"};
    const auto add = [&](std::initializer_list<std::string> more) { words.insert(words.end(), more); };
    add({"-f", "rawvideo", "-pixel_format", "rgba", "-video_size", fmt::format("{}x{}", width, height)});
    add({"-framerate", fmt::format("{}", fps), "-i", "pipe:0"});
    // Colour is kept at half the size, so sides must be even: an odd last row or column goes. Players take the colours
    // of a film that says nothing for those of old television.
    const std::string even = "crop=trunc(iw/2)*2:trunc(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv";
    const std::string colors = "setparams=range=tv:colorspace=bt709:color_primaries=bt709:color_trc=iec61966-2-1";
    if (format == "gif")
        add({"-vf", "split[a][b];[a]palettegen[p];[b][p]paletteuse"}); // the film's own 256 colours
    else
        add({"-vf", fmt::format("{},format={},{}", even, transparent ? "yuva420p" : "yuv420p", colors)});
    if (format == "mp4")
        add({"-crf", "18", "-movflags", "+faststart"});
    if (format == "webm")
        add({"-crf", "24", "-b:v", "0"});
    // The file is called otherwise until it is whole, so its ending says nothing; and a name may begin with a dash.
    add({"-f", format, "file:" + file.string()});
    return words;
}

static fs::path place_of(const fs::path& file)
{
    std::error_code error;
    return fs::is_symlink(file, error) ? fs::weakly_canonical(file, error) : file; // as write_file()
}

static char unfinished[4096]; // path of the film that is being written

static void leave_nothing(int signal) // calls only what may be called at any moment
{
    unlink(unfinished);
    std::signal(signal, SIG_DFL);
    raise(signal);
}

Film::Film(const fs::path& file, int width, int height, double fps, bool transparent)
    : file_(place_of(file)), beside_(file_.string() + fmt::format(".{}.new", getpid())),
      frame_bytes_(size_t(4) * size_t(width) * size_t(height))
{
    const std::vector<std::string> words = film_command(film_format(file), beside_, width, height, fps, transparent);
    std::vector<char*> arguments;
    for (const std::string& word : words)
        arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);

    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        throw fail("{}: no pipe to ffmpeg: {}", file.string(), std::strerror(errno));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO); // standard output is not its to use
    const int error = posix_spawnp(&process_, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[0]);
    if (error != 0)
    {
        close(ends[1]);
        throw fail("{}: ffmpeg cannot be started: {}", file.string(), std::strerror(error));
    }
    pipe_ = ends[1];
    assert(!*unfinished && beside_.native().size() < sizeof unfinished);
    std::strncpy(unfinished, beside_.c_str(), sizeof unfinished - 1);
    // Only now that ffmpeg has started, which would inherit what is ignored.
    for (const auto& [signal, handler] :
         {std::pair(SIGPIPE, SIG_IGN), {SIGINT, leave_nothing}, {SIGTERM, leave_nothing}, {SIGHUP, leave_nothing}})
    {
        before_.emplace_back(signal, std::signal(signal, handler));
        if (before_.back().second == SIG_IGN)
            std::signal(signal, SIG_IGN);
    }
}

Film::~Film()
{
    for (const auto& [signal, handler] : before_)
        std::signal(signal, handler);
    *unfinished = 0;
    if (process_ < 0)
        return;
    kill(process_, SIGTERM);
    close(pipe_);
    waitpid(process_, nullptr, 0);
    std::error_code ignored;
    fs::remove(beside_, ignored);
}

void Film::add(const Image& image)
{
    assert(image.pixels.size() == frame_bytes_);
    const unsigned char* from = image.pixels.data();
    for (size_t left = image.pixels.size(); left > 0;)
    {
        const ssize_t written = write(pipe_, from, left);
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            end(false);
        from += written;
        left -= size_t(written);
    }
}

void Film::finish() { end(true); }

void Film::end(bool whole)
{
    close(pipe_);
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR)
    {
    }
    process_ = -1;
    std::error_code error, ignored;
    whole = whole && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (whole)
        fs::rename(beside_, file_, error);
    if (whole && !error)
        return;
    fs::remove(beside_, ignored);
    throw fail("{}: {}; with -o {} the pictures are kept instead", file_.string(),
               whole ? "cannot be written: " + error.message() : "ffmpeg could not make the film",
               (file_.parent_path() / file_.stem()).string() + "_%04d.png");
}

} // namespace coif
