// Undo as a property: whatever is done, taken back all of it gives the first state, and done again the last.
#include "app/history.h"
#include "sim/source.h"
#include "tests/host/entries.h"
#include "tests/host/scratch.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

namespace coif
{
namespace
{

const Edit& undo(History& history) { return go_to(history, history.now - std::min<size_t>(history.now, 1)); }
const Edit& redo(History& history) { return go_to(history, history.now + 1); }

Hairstyle bob() { return load_hairstyle(data_folder() / "hairstyles" / "bob.toml"); }

// All that a style is, as bytes.
std::string bytes(const Hairstyle& style)
{
    std::string all(sizeof style.params, '\0');
    memcpy(all.data(), &style.params, sizeof style.params);
    return all + style.file.string() + style.text + hairstyle_text(style, style.file);
}

// A change of any parameter to another value that it may have, or of the colliders.
void change(Hairstyle& style, std::mt19937& random)
{
    const std::span<const ParamInfo> table = param_table();
    const ParamInfo& info = table[random() % table.size()];
    if (info.kind == Kind::LIST)
        test::add_entry(style, info, random);
    if (info.on_host())
        return;
    double values[kMostNumbers];
    for (double& value : values)
    {
        const double share = double(random() % 1000) / 999.0;
        value = info.min + share * (info.max - info.min);
        if (info.kind == Kind::INT || info.kind == Kind::CHOICE)
            value = std::round(value);
    }
    set_numbers(style.params, info, values);
}

TEST(History, any_sequence_taken_back_gives_the_first_state_byte_for_byte)
{
    for (unsigned seed = 0; seed < 6; ++seed)
    {
        std::mt19937 random(seed);
        Hairstyle style = bob();
        const Hairstyle saved = style;
        const std::string first = bytes(style);
        History history = begin_history(style, saved);
        size_t done = 0;
        for (int i = 0; i < 60; ++i)
        {
            if (random() % 4 == 0)
                style = undo(history).style;
            else if (random() % 5 == 0)
                style = redo(history).style;
            else
            {
                change(style, random);
                done += note_edit(history, style, saved);
            }
            EXPECT_EQ(difference(style, history.edits[history.now].style), "");
        }
        EXPECT_GT(done, 20u);
        const std::string last = bytes(style);
        const size_t steps = history.now;
        for (size_t i = 0; i < steps; ++i)
            style = undo(history).style;
        EXPECT_EQ(bytes(style), first) << "seed " << seed;
        EXPECT_EQ(bytes(undo(history).style), first);
        for (size_t i = 0; i < steps; ++i)
            style = redo(history).style;
        EXPECT_EQ(bytes(style), last) << "seed " << seed;
        EXPECT_EQ(bytes(go_to(history, 0).style), first);
    }
}

TEST(History, says_what_was_done)
{
    Hairstyle style = bob();
    History history = begin_history(style, style);
    EXPECT_EQ(history.edits[0].what, "opened bob");
    EXPECT_FALSE(note_edit(history, style, style));
    style.params.strand_length = 0.2f;
    EXPECT_TRUE(note_edit(history, style, style));
    EXPECT_EQ(history.edits[1].what, "strand.length 0.185 to 0.2");
    style.params.strand_length = 0.3f;
    style.params.forces_drag = 1.0f;
    style.params.grid_resolution = 32;
    note_edit(history, style, style);
    EXPECT_EQ(history.edits[2].what, "strand.length and 2 more");
    style.host.colliders.push_back({{0.0f, 0.0f, 0.0f}, 0.1f, true});
    note_edit(history, style, style);
    EXPECT_EQ(history.edits[3].what, "collider");
    note_edit(history, bob(), bob(), "opened bob");
    EXPECT_EQ(history.edits[4].what, "opened bob");
}

TEST(History, something_new_forgets_what_was_undone)
{
    Hairstyle style = bob();
    History history = begin_history(style, style);
    for (const float length : {0.1f, 0.2f, 0.3f})
    {
        style.params.strand_length = length;
        note_edit(history, style, style);
    }
    style = undo(history).style;
    style = undo(history).style;
    EXPECT_EQ(style.params.strand_length, 0.1f);
    style.params.root_lift = 10.0f;
    note_edit(history, style, style);
    EXPECT_EQ(history.edits.size(), 3u);
    EXPECT_EQ(redo(history).style.params.root_lift, 10.0f);
    EXPECT_EQ(undo(history).style.params.strand_length, 0.1f);
}

TEST(History, a_save_is_one_whichever_state_one_goes_back_to)
{
    Hairstyle style = bob();
    History history = begin_history(style, style);
    style.params.strand_length = 0.2f;
    note_edit(history, style, style);
    Hairstyle saved = style;
    saved.text += "# saved\n";
    note_save(history, saved);
    const Edit& back = undo(history);
    EXPECT_EQ(back.style.text, saved.text);
    EXPECT_EQ(back.saved.params.strand_length, 0.2f);
    EXPECT_EQ(back.style.params.strand_length, bob().params.strand_length);
}

TEST(History, a_save_under_another_name_takes_what_was_done_before_along)
{
    Hairstyle style = bob();
    style.file = "first.toml";
    History history = begin_history(style, style);
    style.params.strand_length = 0.2f;
    note_edit(history, style, style);
    style.file = "second.toml"; // opened
    note_edit(history, style, style, "opened second");
    style.params.strand_length = 0.3f;
    note_edit(history, style, style);
    style.params.strand_length = 0.4f;
    note_edit(history, style, style);
    undo(history);
    Hairstyle saved = history.edits[history.now].style;
    saved.file = "third.toml";
    note_save(history, saved);
    EXPECT_EQ(redo(history).style.file, "third.toml");
    undo(history);
    const Edit& opened = undo(history);
    EXPECT_EQ(opened.style.file, "third.toml");
    EXPECT_EQ(opened.style.params.strand_length, 0.2f);
    EXPECT_EQ(opened.saved.params.strand_length, 0.3f) << "it differs from what is on disk";
    EXPECT_EQ(undo(history).style.file, "first.toml") << "another file's";
}

TEST(History, forgets_the_oldest_only)
{
    Hairstyle style = bob();
    History history = begin_history(style, style);
    for (size_t i = 0; i < kMostEdits + 10; ++i)
    {
        style.params.forces_drag = 1.0f + float(i) * 0.01f;
        note_edit(history, style, style);
    }
    EXPECT_EQ(history.edits.size(), kMostEdits);
    EXPECT_EQ(history.now, kMostEdits - 1);
    EXPECT_EQ(history.edits.back().style.params.forces_drag, style.params.forces_drag);
}

} // namespace
} // namespace coif
