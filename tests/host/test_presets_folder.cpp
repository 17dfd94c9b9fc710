// What the browser of presets does with files, without its window; and how a window is arranged, kept between runs.
#include "app/presets.h"
#include "app/settings.h"
#include "app/watch.h"
#include "sim/hairstyle.h"
#include "tests/host/scratch.h"

namespace coif
{
namespace
{
using namespace coif::test;

TEST(PresetFiles, are_listed_and_found_by_name)
{
    const Scratch scratch;
    for (const char* name : {"b.toml", "Bob.toml", "a.toml", "picture.png", "trash/old.toml"})
        scratch.write(name, "");
    fs::create_directories(scratch / "folder.toml");
    const std::vector<fs::path> files = hairstyles_in(scratch.folder());
    EXPECT_EQ(files, (std::vector<fs::path>{scratch / "Bob.toml", scratch / "a.toml", scratch / "b.toml"}));
    EXPECT_EQ(filtered(files, "BO"), std::vector<fs::path>{scratch / "Bob.toml"});
    EXPECT_EQ(filtered(files, "").size(), 3u);
    EXPECT_TRUE(hairstyles_in(scratch / "none").empty());
}

TEST(PresetFiles, are_made_copied_renamed_and_thrown_away_but_never_lost)
{
    const Scratch scratch;
    const fs::path bob = scratch.write("bob.toml", "# mine\n[strand]\nlength = 0.3 # short\n");
    const fs::path fresh = new_hairstyle(scratch.folder(), "fresh");
    EXPECT_EQ(load_hairstyle(fresh).name(), "fresh");
    const fs::path copy = duplicate_hairstyle(bob, unused_hairstyle(scratch.folder(), "bob"));
    EXPECT_EQ(copy, scratch / "bob-2.toml");
    EXPECT_EQ(bytes_of(copy), bytes_of(bob));
    EXPECT_EQ(unused_hairstyle(scratch.folder(), "bob"), "bob-3");
    const fs::path named = rename_hairstyle(copy, "long bob \xc3\xa9");
    EXPECT_TRUE(fs::exists(named));
    EXPECT_FALSE(fs::exists(copy));
    for (const char* taken : {"bob", "fresh"})
        EXPECT_NE(error_of([&] { rename_hairstyle(named, taken); }).find("already"), std::string::npos);
    for (const char* odd : {"", ".hidden", "a/b", "..", "a\nb"})
    {
        EXPECT_NE(error_of([&] { rename_hairstyle(bob, odd); }).find("is no name"), std::string::npos) << odd;
        EXPECT_NE(error_of([&] { new_hairstyle(scratch.folder(), odd); }).find("is no name"), std::string::npos);
    }
    EXPECT_EQ(trash_hairstyle(bob), scratch / "trash" / "bob.toml");
    scratch.write("bob.toml", "another");
    EXPECT_EQ(trash_hairstyle(bob), scratch / "trash" / "bob-2.toml");
    EXPECT_EQ(bytes_of(scratch / "trash" / "bob.toml"), "# mine\n[strand]\nlength = 0.3 # short\n");
    EXPECT_EQ(bytes_of(scratch / "trash" / "bob-2.toml"), "another");
    EXPECT_EQ(hairstyles_in(scratch.folder()).size(), 2u);
}

TEST(PresetFiles, a_copy_of_a_preset_has_its_own_rest_shape)
{
    const Scratch scratch;
    Hairstyle bob;
    StrandShapes shapes;
    shapes.nodes = 8;
    for (int k = 0; k < 8; ++k)
        shapes.position.emplace_back(0.0f, 0.1f + 0.01f * float(k), 0.0f);
    bob.host.groom_rest.shapes = std::make_shared<const StrandShapes>(shapes);
    bob.host.regions.emplace_back().name = "painted";
    bob.host.regions[0].weights.assign(5000, 0.25f);
    save_hairstyle(bob, scratch / "bob.toml");
    EXPECT_EQ(files_beside(bob), (std::vector<fs::path>{scratch / "bob.rest", scratch / "bob.region"}));
    scratch.write("copy.rest", "somebody else's");

    Hairstyle copy = load_hairstyle(duplicate_hairstyle(scratch / "bob.toml", "copy"));
    EXPECT_EQ(files_beside(copy), (std::vector<fs::path>{scratch / "copy.2.rest", scratch / "copy.region"}));
    EXPECT_EQ(bytes_of(scratch / "copy.rest"), "somebody else's");
    EXPECT_EQ(bytes_of(scratch / "copy.2.rest"), bytes_of(scratch / "bob.rest"));
    EXPECT_EQ(copy.host.regions,
              [&]
              {
                  auto all = bob.host.regions;
                  all[0].file = "copy.region";
                  return all;
              }());

    // What is done to the copy is not done to the first, even when that has gone.
    shapes.position[7].x = 0.05f;
    copy.host.groom_rest.shapes = std::make_shared<const StrandShapes>(shapes);
    copy.host.regions[0].weights[0] = 1.0f;
    save_hairstyle(copy, copy.file);
    EXPECT_TRUE(same_style(load_hairstyle(scratch / "bob.toml"), bob));
    for (const char* gone : {"bob.toml", "bob.rest", "bob.region"})
        fs::remove(scratch / gone);
    const Hairstyle again = load_hairstyle(scratch / "copy.toml");
    EXPECT_EQ(*again.host.groom_rest.shapes, shapes);
    EXPECT_EQ(again.host.regions[0].weights, copy.host.regions[0].weights);
}

TEST(PresetFiles, weights_of_a_region_in_a_file_that_cannot_be_are_told_with_their_place)
{
    const Scratch scratch;
    const auto told = [&](const char* weights, const char* region)
    {
        if (weights)
            scratch.write("r.region", weights);
        scratch.write("bob.toml", std::string("[[region]]\nname = \"a\"\n") + region);
        return error_of([&] { load_hairstyle(scratch / "bob.toml"); });
    };
    const std::string gone = told(nullptr, "file = \"r.region\"\n");
    EXPECT_NE(gone.find("bob.toml:3:8: "), std::string::npos) << gone;
    EXPECT_NE(gone.find("no such file"), std::string::npos) << gone;
    for (const char* spoilt : {"0.5\n1.5\n", "0.5\n-0.1", "0\nx", "0\nnan"})
    {
        const std::string error = told(spoilt, "file = \"r.region\"\n");
        EXPECT_NE(error.find("r.region:2: must hold numbers from 0 to 1 only"), std::string::npos) << error;
    }
    const std::string both = told("0.5", "file = \"r.region\"\nweights = [1]\n");
    EXPECT_NE(both.find("bob.toml:4:11: region.weights must be left out"), std::string::npos) << both;
}

TEST(Watch, what_we_have_written_ourselves_is_known)
{
    const Scratch scratch;
    Hairstyle style;
    style.host.regions.emplace_back().name = "painted";
    style.host.regions[0].weights.assign(5000, 0.25f);
    save_hairstyle(style, scratch / "a.toml");
    Watch watch;
    std::vector<fs::path> files = files_beside(style);
    files.push_back(style.file);
    watch.set(files);
    for (const bool told : {false, true})
    {
        style.host.regions[0].weights[0] = told ? 0.5f : 0.75f;
        save_hairstyle(style, style.file);
        for (const fs::path& file : files)
            if (told)
                watch.know(file);
        watch.changed(); // what has just changed waits for the next look
        EXPECT_EQ(watch.changed().size(), told ? 0u : 2u);
    }
}

TEST(PresetFiles, a_folder_that_refuses_is_told_and_loses_nothing)
{
    const Scratch scratch;
    const fs::path bob = scratch.write("bob.toml", "# mine\n");
    scratch.write("trash", "a file where the folder should be");
    EXPECT_NE(error_of([&] { trash_hairstyle(bob); }).find("trash: the folder cannot be made"), std::string::npos);
    EXPECT_EQ(bytes_of(bob), "# mine\n");
    EXPECT_NE(error_of([&] { new_hairstyle(scratch / "none", "x"); }).find("cannot be written"), std::string::npos);
    EXPECT_NE(error_of([&] { duplicate_hairstyle(scratch / "gone.toml", "x"); }).find("no such file"),
              std::string::npos);
    EXPECT_NE(error_of([&] { rename_hairstyle(scratch / "gone.toml", "x"); }).find("cannot become"), std::string::npos);
    if (geteuid() != 0) // root writes everywhere
    {
        fs::permissions(scratch.folder(), fs::perms::owner_read | fs::perms::owner_exec);
        EXPECT_NE(error_of([&] { new_hairstyle(scratch.folder(), "x"); }).find("cannot be written"), std::string::npos);
        fs::permissions(scratch.folder(), fs::perms::owner_all);
    }
}

TEST(Settings, come_back_as_they_were_kept)
{
    const Scratch scratch;
    Settings settings;
    settings.width = 1400;
    settings.height = 900;
    settings.panel = false;
    settings.browser = true;
    settings.give_way = false;
    settings.folded = {"strand", "wave"};
    settings.locked = {"strand.length"};
    settings.windows = "[Window][presets]\nPos=60,60\nSize=400,300\nCollapsed=0\n\n";
    const fs::path file = scratch / "new" / "editor.ini";
    save_settings(file, settings);
    EXPECT_EQ(load_settings(file), settings);
    EXPECT_EQ(load_settings(scratch / "none"), Settings());
}

TEST(Settings, what_is_spoilt_is_left_out)
{
    const Settings read = parse_settings("rubbish\n[coif][editor]\nwidth=99999999999999\nheight=-3\nfolded=nothing\n"
                                         "folded=wave\nlocked=no.such\nhistory=1\n=\nx\n[Table][0x1,2000000000]\n"
                                         "Column 0 Width=3\n[Window][presets]\nPos=1,2\n[Other][x]\nfolded=strand\n");
    Settings expected;
    expected.history = true;
    expected.folded = {"wave"};
    expected.windows = "[Window][presets]\nPos=1,2\n";
    EXPECT_EQ(read, expected);
    std::mt19937 random(3);
    for (int i = 0; i < 200; ++i)
    {
        std::string text = settings_text(expected);
        for (int k = 0; k < 8; ++k)
            text[random() % text.size()] = char(random() % 256);
        parse_settings(text);
    }
    const Scratch scratch;
    scratch.write("folder", "a file");
    EXPECT_NE(error_of([&] { save_settings(scratch / "folder" / "editor.ini", expected); }), "no error");
}

} // namespace
} // namespace coif
