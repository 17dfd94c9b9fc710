#pragma once
#include "sim/hairstyle.h"

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace coif
{

// Unsaved work that an editor which is no more has left behind.
struct Recovery
{
    std::filesystem::path kept; // where it lies
    std::filesystem::path file; // the hairstyle that it is of; empty: one that was never saved
    std::string text;           // that hairstyle, as it would have been saved
    std::string when;           // it was last kept, "14:05" or "2025-03-01 14:05"
};

// In `folder`, the newest first. What an editor that still runs keeps there is not among it. Never throws: what cannot
// be read is left alone.
std::vector<Recovery> find_recoveries(const std::filesystem::path& folder);

// The hairstyle that was being worked on. Throws Error.
Hairstyle recovered(const Recovery& recovery);

// Keeps the unsaved work of one editor in `folder`, so that a crash, at any moment, loses at most two seconds of it. A
// thread of its own writes beside and renames, so that neither a slow disk holds the window up nor a slow window the
// keeping. A file belongs to this editor as long as it holds the lock beside it, which the system takes back however
// the program ends: editors on one hairstyle each keep their own.
class Autosave
{
  public:
    // Writes no more often than every `delay`. Without a folder it keeps nothing.
    explicit Autosave(std::filesystem::path folder, std::chrono::milliseconds delay = std::chrono::seconds(1));
    ~Autosave(); // finishes what is to be written, and leaves it there
    Autosave(const Autosave&) = delete;

    void keep(const Hairstyle& style); // it is unsaved
    void clear();                      // there is nothing unsaved
    // What was left behind is this editor's now, and goes when its work is saved. False if another was faster.
    bool take_over(const Recovery& recovery);
    std::string trouble(); // why keeping has failed since last asked; empty: it has not

  private:
    void write_in_turn();
    void write(const Hairstyle& style);
    void remove();

    std::filesystem::path folder_, lock_file_, kept_; // kept_: what is on disk now
    std::chrono::milliseconds delay_;
    int lock_ = -1;
    std::mutex mutex_; // of what follows; kept_ is the thread's, or whoever holds `files_`
    std::mutex files_;
    std::condition_variable news_;
    std::optional<Hairstyle> pending_;
    bool clear_ = false, end_ = false;
    std::string trouble_;
    std::thread thread_;
};

// Throws away what was left behind.
void discard(const Recovery& recovery);

} // namespace coif
