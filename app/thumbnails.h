#pragma once
#include "app/image.h"
#include "sim/hash.h"

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <sys/types.h>
#include <vector>

namespace coif
{

// Small pictures of hairstyles, drawn by `coif shot` in a process of its own, one at a time and at low priority: a
// style that takes long, hangs or brings its process down does none of that to the editor. A picture is kept in
// `folder` under a hash of all it depends on (the style, the files that it names, kernels and shaders), so that equal
// content is drawn once, and a change drawn anew. What lies there and is no such picture is drawn again.
class Thumbnails
{
  public:
    static constexpr int kSize = 192; // pixels a side

    // `program`: coif. `device`: as --device takes it.
    Thumbnails(std::filesystem::path folder, std::filesystem::path program, std::string device);
    ~Thumbnails(); // ends what is being drawn
    Thumbnails(const Thumbnails&) = delete;

    struct Entry
    {
        enum State
        {
            WAITING,
            DRAWN,
            FAILED
        } state = WAITING;
        Image image;        // if DRAWN
        std::string why;    // if FAILED
        int version = 0;    // counts up with every change of the above
        std::string key;    // its file's name in the folder; empty: not known yet
        long wanted = 0;    // when it was last asked for, in calls of work()
        bool tried = false; // drawn under this key, so that what fails is not drawn for ever
        std::map<std::filesystem::path, std::filesystem::file_time_type> files; // that the key is of
    };

    const Entry& of(const std::filesystem::path& style); // as far as it is known; asks for it
    // Does a little of what has been asked for. True if that has changed something. Never throws.
    bool work();
    bool busy() const { return child_ > 0; }

  private:
    void find_key(const std::filesystem::path& style, Entry& entry);
    bool read_kept(Entry& entry);
    bool look_after_child();
    void draw(const std::filesystem::path& style, Entry& entry);
    Hash hash_of(const std::filesystem::path& file);
    std::filesystem::path place(const Entry& entry, const char* ending) const { return folder_ / (entry.key + ending); }

    std::filesystem::path folder_, program_;
    std::string device_;
    std::map<std::filesystem::path, Entry> entries_;
    std::map<std::filesystem::path, std::pair<std::filesystem::file_time_type, Hash>> hashes_;
    pid_t child_ = 0;
    std::filesystem::path drawing_; // the style that the child draws
    std::string drawing_key_;
    std::chrono::steady_clock::time_point since_, looked_;
    long calls_ = 0;
};

// The program `coif` that this one is, or that lies beside it.
std::filesystem::path coif_program();

} // namespace coif
