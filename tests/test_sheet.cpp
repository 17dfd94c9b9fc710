// Sheets, sequences, turntables and films, as the program writes them.
#include "app/sheet.h"
#include "tests/commands.h"

#include <sstream>

using namespace coif;
using namespace coif::test;

namespace
{
const char kSmall[] = " --size 64x56 --samples 2 ";

class Pictures : public Commands
{
  protected:
    void SetUp() override
    {
        Commands::SetUp();
        write("red.toml",
              "[interpolation]\nstrands = 200\n[grid]\nresolution = 16\n[look]\nroot_color = \"#a01010\"\n");
        write("short.toml", "[strand]\nlength = 0.05\n[interpolation]\nstrands = 200\n[grid]\nresolution = 16\n");
    }
    static Image part(const Image& image, int x, int y, int width, int height)
    {
        Image cut{width, height, {}};
        for (int row = y; row < y + height; ++row)
            cut.pixels.insert(cut.pixels.end(), image.pixels.begin() + 4 * (row * image.width + x),
                              image.pixels.begin() + 4 * (row * image.width + x + width));
        return cut;
    }
    static int bright(const Image& image)
    {
        int count = 0;
        for (size_t i = 0; i < image.pixels.size(); i += 4)
            count += image.pixels[i] > 150 && image.pixels[i + 1] > 150;
        return count;
    }
    // A program called ffmpeg that notes its words, one a line, and keeps what comes in.
    std::string with_ffmpeg(const std::string& does = "cat > \"${last#file:}\"")
    {
        fs::create_directories(folder / "bin");
        write("bin/ffmpeg", "#!/bin/sh\nfor last; do echo \"$last\"; done > '" + (folder / "words.txt").string() +
                                "'\n" + does + "\n");
        fs::permissions(folder / "bin/ffmpeg", fs::perms::owner_all);
        return "PATH='" + (folder / "bin").string() + "':\"$PATH\"";
    }
    std::vector<std::string> files() const
    {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }
    bool has_litter() const
    {
        for (const std::string& name : files())
            if (name.ends_with(".new"))
                return true;
        return false;
    }
};
} // namespace

TEST_F(Pictures, a_sheet_of_levels_shows_each_style_five_times_with_two_lines_below)
{
    const Result result = coif("sheet red.toml short.toml --levels 2 -o levels.png" + std::string(kSmall));
    ASSERT_EQ(result.status, 0) << result.err;
    const Image page = load_png(folder / "levels.png");
    const SheetLayout at = lay_out(10, 5, 64, 56, 2);
    ASSERT_EQ(page.width, at.width);
    ASSERT_EQ(page.height, at.height);
    for (int cell = 0; cell < 10; ++cell)
        for (const int line : {0, 1})
            EXPECT_GT(bright(part(page, at.x(cell), at.y(cell) + 56 + at.letters / 2 + line * at.line_height(), 64,
                                  at.letters)),
                      5)
                << cell << " " << line;
    // Traced light is not that of any level.
    for (int level = 0; level < 4; ++level)
        EXPECT_NE(part(page, at.x(level), at.y(level), 64, 56).pixels, part(page, at.x(4), at.y(4), 64, 56).pixels);

    EXPECT_EQ(coif("sheet red.toml --levels 0 -o x.png" + std::string(kSmall)).status, 2);
    const Result two = coif("sheet red.toml --levels 2 -j 2 -o x.png" + std::string(kSmall));
    EXPECT_EQ(two.status, 1);
    EXPECT_NE(two.err.find("disturb each other's cost"), two.err.npos) << two.err;
}

TEST_F(Pictures, a_sheet_shows_every_style_in_order_with_its_name)
{
    const std::string call = std::string("sheet red.toml small.toml short.toml --columns 2 --time 0.1") + kSmall;
    const Result first = coif(call + "-o a.png"), second = coif(call + "-o b.png");
    ASSERT_EQ(first.status, 0) << first.err;
    EXPECT_EQ(first.out, "") << "words go to standard error";
    EXPECT_EQ(first.err, "wrote a.png: 3 of 3 styles\n");
    EXPECT_EQ(contents("a.png"), contents("b.png"));

    const Image page = load_png(folder / "a.png");
    const SheetLayout at = lay_out(3, 2, 64, 56);
    ASSERT_EQ(page.width, at.width);
    ASSERT_EQ(page.height, at.height);
    const char* styles[] = {"red", "small", "short"};
    std::vector<std::vector<unsigned char>> labels;
    for (int i = 0; i < 3; ++i)
    {
        ASSERT_EQ(coif(std::string("shot ") + styles[i] + ".toml --time 0.1 -o one.png" + kSmall).status, 0);
        EXPECT_EQ(part(page, at.x(i), at.y(i), 64, 56).pixels, load_png(folder / "one.png").pixels)
            << styles[i] << " is as its shot";
        const Image label = part(page, at.x(i), at.y(i) + 56, 64, at.label_height());
        EXPECT_GT(bright(label), 15) << styles[i];
        labels.push_back(label.pixels);
    }
    EXPECT_NE(labels[0], labels[1]);
    EXPECT_NE(labels[1], labels[2]);
    const Image empty = part(page, at.x(3), at.y(3), 64, 56 + at.label_height());
    for (size_t i = 0; i < empty.pixels.size(); i += 4)
        ASSERT_TRUE(std::equal(&empty.pixels[i], &empty.pixels[i] + 4, page.pixels.data())) << "plain";
}

TEST_F(Pictures, a_sheet_plays_any_motion_and_sets_all_styles)
{
    const std::string call = std::string("sheet small.toml red.toml -o ") + "a.png --motion shake --time 0.4" + kSmall;
    ASSERT_EQ(coif(call + "--camera back --set look.width=0.002").status, 0);
    const SheetLayout at = lay_out(2, std::nullopt, 64, 56);
    const Image page = load_png(folder / "a.png");
    ASSERT_EQ(coif(std::string("shot red.toml -o one.png --motion shake --time 0.4 --camera back") + kSmall +
                   "--set look.width=0.002")
                  .status,
              0);
    EXPECT_EQ(part(page, at.x(1), at.y(1), 64, 56).pixels, load_png(folder / "one.png").pixels);
}

TEST_F(Pictures, a_style_that_fails_is_told_and_the_others_are_drawn)
{
    write("broken.toml", "[strand]\nlength = \"long\"\n");
    const Result result = coif(std::string("sheet small.toml broken.toml missing red.toml -o a.png --time 0") + kSmall);
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("broken.toml:2:10: strand.length must be a number, not text\n"), std::string::npos)
        << result.err;
    EXPECT_NE(result.err.find("'missing' is neither a file nor"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("wrote a.png: 2 of 4 styles\n"), std::string::npos) << result.err;
    const SheetLayout at = lay_out(4, std::nullopt, 64, 56);
    const Image page = load_png(folder / "a.png");
    const Image failed = part(page, at.x(1), at.y(1), 64, 56), good = part(page, at.x(3), at.y(3), 64, 56);
    EXPECT_EQ(failed.pixels, part(page, at.x(2), at.y(2), 64, 56).pixels);
    ASSERT_EQ(coif(std::string("shot red.toml --time 0 -o one.png") + kSmall).status, 0);
    EXPECT_EQ(good.pixels, load_png(folder / "one.png").pixels) << "what failed before leaves no trace";

    const Result none = coif(std::string("sheet broken.toml missing -o none.png") + kSmall);
    EXPECT_EQ(none.status, 1);
    EXPECT_NE(none.err.find("none of the styles"), std::string::npos) << none.err;
    EXPECT_FALSE(fs::exists(folder / "none.png"));
}

TEST_F(Pictures, a_sequence_has_the_same_bytes_as_single_shots)
{
    const Result run = coif(std::string("shot small.toml --motion shake --frames 4:7 --fps 20 -o s_%03d.png") + kSmall);
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.err, "wrote 4 pictures, s_004.png to s_007.png\n");
    const char* times[] = {"0.2", "0.25", "0.3", "0.35"};
    for (int i = 0; i < 4; ++i)
    {
        ASSERT_EQ(coif(std::string("shot small.toml --motion shake -o one.png --time ") + times[i] + kSmall).status, 0);
        EXPECT_EQ(contents("s_00" + std::to_string(4 + i) + ".png"), contents("one.png")) << times[i];
    }
    EXPECT_NE(contents("s_004.png"), contents("s_005.png"));
    EXPECT_FALSE(has_litter());
}

TEST_F(Pictures, a_turntable_begins_with_the_shot_and_goes_round)
{
    ASSERT_EQ(coif(std::string("shot small.toml --time 0.2 --turntable 4 -o t.png") + kSmall).status, 0);
    ASSERT_EQ(coif(std::string("shot small.toml --time 0.2 -o one.png") + kSmall).status, 0);
    EXPECT_EQ(contents("t_0000.png"), contents("one.png"));
    ASSERT_EQ(coif(std::string("shot small.toml --time 0.2 --camera 115,5 -o one.png") + kSmall).status, 0);
    const Image turned = load_png(folder / "t_0001.png"), asked = load_png(folder / "one.png");
    int most = 0;
    for (size_t i = 0; i < turned.pixels.size(); ++i)
        most = std::max(most, std::abs(int(turned.pixels[i]) - int(asked.pixels[i])));
    EXPECT_LE(most, 2) << "a quarter turn from 25 degrees";
    EXPECT_FALSE(fs::exists(folder / "t_0004.png"));

    ASSERT_EQ(coif(std::string("shot small.toml --motion shake --frames 0:3 --turntable 2 -o m.png") + kSmall).status,
              0);
    ASSERT_EQ(coif(std::string("shot small.toml --motion shake --frames 2:2 -o n.png") + kSmall).status, 0);
    EXPECT_EQ(contents("m_0002.png"), contents("n_0002.png")) << "round once, and further in time";
}

TEST_F(Pictures, a_film_is_piped_to_ffmpeg_and_renamed)
{
    const std::string path = with_ffmpeg();
    write("it's.mp4", "old");
    const Result run = coif(std::string("shot small.toml --frames 0:2 --fps 25 -o \"it's.mp4\"") + kSmall, path);
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.err, "wrote it's.mp4: 3 pictures, 0.12 s\n");
    const std::string words = contents("words.txt");
    EXPECT_NE(words.find("\n-video_size\n64x56\n-framerate\n25\n"), std::string::npos) << words;
    ASSERT_EQ(coif(std::string("shot small.toml --frames 0:2 --fps 25 -o f.png") + kSmall).status, 0);
    std::string raw;
    for (const char* name : {"f_0000.png", "f_0001.png", "f_0002.png"})
    {
        const Image image = load_png(folder / name);
        raw.append(image.pixels.begin(), image.pixels.end());
    }
    EXPECT_EQ(contents("it's.mp4"), raw);
    EXPECT_FALSE(has_litter());
}

TEST_F(Pictures, a_film_that_ffmpeg_cannot_make_leaves_the_old_one)
{
    write("clip.webm", "old");
    for (const char* does : {"exit 3", "cat > /dev/null; exit 3", "echo part > \"${last#file:}\"; kill -9 $$"})
    {
        const Result run =
            coif(std::string("shot small.toml --turntable 30 --time 0 -o clip.webm") + kSmall, with_ffmpeg(does));
        EXPECT_EQ(run.status, 1) << does;
        EXPECT_NE(run.err.find("clip.webm: ffmpeg could not make the film; with -o clip_%04d.png"), std::string::npos)
            << run.err;
        EXPECT_EQ(contents("clip.webm"), "old");
        EXPECT_FALSE(has_litter()) << does;
    }
}

TEST_F(Pictures, a_film_broken_off_leaves_the_old_one)
{
    write("clip.mp4", "old");
    const std::string interrupts =
        "echo part > \"${last#file:}\"; head -c 20000 > /dev/null; kill -INT $PPID; cat > /dev/null";
    const Result run =
        coif(std::string("shot small.toml --frames 0:99999 -o clip.mp4") + kSmall, with_ffmpeg(interrupts));
    EXPECT_EQ(run.status, 130) << run.err;
    EXPECT_EQ(contents("clip.mp4"), "old");
    EXPECT_FALSE(has_litter());
}

TEST_F(Pictures, without_ffmpeg_the_pictures_are_kept_and_it_is_said)
{
    // What the device's compiler needs of PATH is built by now.
    ASSERT_EQ(coif(std::string("shot small.toml --time 0.1 -o one.png") + kSmall).status, 0);
    const Result run = coif(std::string("shot small.toml --frames 0:1 -o clip.gif") + kSmall, "PATH=/nowhere");
    EXPECT_EQ(run.status, 1) << "what was asked for is not there";
    EXPECT_NE(run.err.find("clip.gif needs ffmpeg, which is not installed"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("wrote 2 pictures, clip_0000.png to clip_0001.png\n"), std::string::npos) << run.err;
    EXPECT_TRUE(fs::exists(folder / "clip_0001.png"));
    EXPECT_FALSE(fs::exists(folder / "clip.gif"));
}

TEST_F(Pictures, what_makes_no_sense_is_refused_in_a_line)
{
    EXPECT_EQ(coif("sheet -o a.png").status, 2) << "no style";
    EXPECT_EQ(coif("sheet small.toml").status, 2) << "no place";
    EXPECT_EQ(coif("sheet small.toml -o a.png --columns many").status, 2);
    EXPECT_EQ(coif("shot small.toml -o a.png --frames 0:1 --time 1").status, 2);
    EXPECT_EQ(coif("shot small.toml -o a.png --turntable 0").status, 2);
    EXPECT_EQ(coif("shot small.toml -o a.png --turntable 99999999999").status, 2);
    for (const char* bad : {"sheet small.toml -o a.png --columns 0",
                            "sheet small.toml -o a.png --columns -3",
                            "sheet small.toml small.toml -o a.png --size 8192x8192",
                            "sheet small.toml -o a.png --size 0x5",
                            "sheet small.toml -o a.png --size 9000x9000",
                            "sheet small.toml -o a.png --samples 0",
                            "sheet small.toml -o a.png --time nan",
                            "sheet small.toml -o a.png --camera sideways",
                            "sheet small.toml -o a.png --motion dance",
                            "sheet small.toml -o a.png --device abacus",
                            "sheet small.toml red.toml -o a.png --set strand.length=-1",
                            "sheet small.toml -o no/such/a.png",
                            "sheet small.toml -o .",
                            "shot small.toml -o a.png --frames 5:4",
                            "shot small.toml -o a.png --frames 5",
                            "shot small.toml -o a.png --frames 0:1 --fps 0",
                            "shot small.toml -o a.png --turntable 99999",
                            "shot small.toml -o a%s.png --frames 0:1",
                            "shot small.toml -o no/such/a.png --frames 0:1",
                            "shot small.toml -o a.mp4",
                            "shot small.toml -o a.mp4 --frames 0:1 --transparent"})
    {
        const Result result = coif(bad);
        EXPECT_EQ(result.status, 1) << bad;
        EXPECT_EQ(result.out, "") << bad;
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << bad << ": " << result.err;
    }
    EXPECT_EQ(files(), (std::vector<std::string>{"err.txt", "out.txt", "red.toml", "short.toml", "small.toml"}));
}
