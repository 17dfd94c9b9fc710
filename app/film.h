#pragma once
#include "app/image.h"

#include <string>
#include <utility>
#include <vector>

namespace coif
{

// mp4, webm or gif, by the ending of the file's name; empty for all others.
std::string film_format(const std::filesystem::path& file);

// Is ffmpeg found in PATH?
bool has_ffmpeg();

// The command line, the program's name first, that makes a film of raw RGBA pictures on standard input, at `file`.
std::vector<std::string> film_command(const std::string& format, const std::filesystem::path& file, int width,
                                      int height, double fps, bool transparent);

// A film that ffmpeg writes beside its place while pictures come in; finish() renames it over. One that is not finished
// leaves nothing behind, even where the user breaks it off. There can be one at a time.
class Film
{
  public:
    // All pictures are to have this size. Throws Error when ffmpeg cannot be started.
    Film(const std::filesystem::path& file, int width, int height, double fps, bool transparent);
    ~Film();
    Film(const Film&) = delete;

    // Both throw Error when ffmpeg has given up; why, it has said on standard error.
    void add(const Image& image);
    void finish();

  private:
    void end(bool whole); // waits for ffmpeg; throws unless the film is whole and in its place

    std::filesystem::path file_, beside_;
    size_t frame_bytes_;
    int pipe_ = -1, process_ = -1;
    std::vector<std::pair<int, void (*)(int)>> before_; // signals and what they did
};

} // namespace coif
