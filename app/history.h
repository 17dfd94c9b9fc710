#pragma once
#include "sim/hairstyle.h"

#include <string>
#include <vector>

namespace coif
{

// A state that the author brought about.
struct Edit
{
    std::string what;       // did it, in a few words
    Hairstyle style, saved; // as it was then, and as its file was
};

// What the author has done, from the first state on; what was undone stays until something else is done.
struct History
{
    std::vector<Edit> edits; // never empty once begun
    size_t now = 0;          // which of them is on screen
};

constexpr size_t kMostEdits = 500; // the oldest are forgotten

History begin_history(const Hairstyle& style, const Hairstyle& saved);

// Takes down what has been done since the last time: `what`, or else what differs in the style. Nothing, if nothing
// does. Returns whether it was something.
bool note_edit(History& history, const Hairstyle& style, const Hairstyle& saved, const std::string& what = {});

// Back or forth to any state, beyond the last to the last. Returns the state to go on with.
const Edit& go_to(History& history, size_t edit);

// After a save: what is on disk now is so whichever state of that file one goes back to. Under a new name all that was
// done since the old one was opened is the new file's, so that going back and saving leaves the old one alone.
void note_save(History& history, const Hairstyle& saved);

// "strand.length 0.25 to 0.2", "strand.length and 3 more"; empty if the two give the same hair and picture.
std::string difference(const Hairstyle& a, const Hairstyle& b);

} // namespace coif
