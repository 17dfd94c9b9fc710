// Many pictures in one run: which frames, which files, where on a sheet, in which letters, by which command line.
#include "app/film.h"
#include "app/lettering.h"
#include "app/sequence.h"
#include "app/sheet.h"
#include "app/shot.h"
#include "tests/host/scratch.h"

#include <algorithm>
#include <cstdlib>
#include <numbers>

namespace coif
{
namespace
{

using test::error_of;
using test::Scratch;

std::vector<Frame> frames(const char* range, double fps = 30.0, int turntable = 0)
{
    return frames_of({range, fps, turntable}, 2.0);
}

TEST(Sequence, frames_lie_at_their_number_over_the_rate)
{
    const std::vector<Frame> some = frames("3:6", 24.0);
    ASSERT_EQ(some.size(), 4u) << "both ends are taken";
    for (size_t i = 0; i < some.size(); ++i)
    {
        EXPECT_EQ(some[i].number, int(i) + 3);
        EXPECT_DOUBLE_EQ(some[i].seconds, (double(i) + 3.0) / 24.0);
        EXPECT_EQ(some[i].turn, 0.0);
    }
    EXPECT_EQ(frames("5:5").size(), 1u);
    EXPECT_EQ(frames("0:99999", 60.0).size(), 100000u);
}

TEST(Sequence, a_turntable_goes_round_once_in_equal_angles)
{
    const std::vector<Frame> still = frames("", 30.0, 8);
    ASSERT_EQ(still.size(), 8u);
    for (size_t i = 0; i < 8; ++i)
    {
        EXPECT_EQ(still[i].number, int(i));
        EXPECT_EQ(still[i].seconds, 2.0) << "all of the same time";
        EXPECT_DOUBLE_EQ(still[i].turn, double(i) * std::numbers::pi / 4.0);
    }
    const std::vector<Frame> moving = frames("10:15", 30.0, 3);
    ASSERT_EQ(moving.size(), 6u);
    for (size_t i = 0; i < 6; ++i)
    {
        EXPECT_DOUBLE_EQ(moving[i].seconds, (10.0 + double(i)) / 30.0);
        EXPECT_DOUBLE_EQ(moving[i].turn, double(i % 3) * 2.0 * std::numbers::pi / 3.0) << "two turns";
    }
}

TEST(Sequence, ranges_that_cannot_be_are_refused)
{
    for (const char* bad : {"5", "5:", ":5", "6:5", "-1:5", "0:100000", "a:b", "0:5x", "0:5:1", "0.5:1", "1e9:2e9",
                            "99999999999999999999:5", " "})
        EXPECT_NE(error_of([&] { frames(bad); }).find(std::string("--frames ") + bad), std::string::npos) << bad;
    EXPECT_NE(error_of([&] { frames("0:99999", 24.0); }).find("3600"), std::string::npos) << "over an hour";
    for (const double bad : {0.0, -30.0, 0.5, 1e6, double(NAN), double(INFINITY)})
        EXPECT_NE(error_of([&] { frames("0:1", bad); }).find("--fps"), std::string::npos) << bad;
    for (const int bad : {-1, 3601, 1 << 30})
        EXPECT_NE(error_of([&] { frames("", 30.0, bad); }).find("--turntable"), std::string::npos) << bad;
}

TEST(Sequence, names_are_numbered_and_never_taken_for_a_format)
{
    EXPECT_EQ(numbered_pattern("a.png"), "a_%04d.png");
    EXPECT_EQ(numbered_pattern("some/folder.x/a"), "some/folder.x/a_%04d.png");
    EXPECT_EQ(numbered_pattern("a%d.png"), "a%d.png");
    EXPECT_EQ(numbered("x/a_%04d.png", 7), "x/a_0007.png");
    EXPECT_EQ(numbered("%03d", 12345), "12345");
    EXPECT_EQ(numbered("a%db", 7), "a7b");
    for (const char* bad : {"%s.png", "%.png", "a%", "%04d%04d.png", "%n", "%99d", "%04x", "%0d", "%%.png", "%4d.png"})
        EXPECT_NE(error_of([&] { numbered_pattern(bad); }).find("%04d"), std::string::npos) << bad;
    EXPECT_NE(error_of([] { numbered_pattern("%d/a.png"); }).find("folder"), std::string::npos);
}

TEST(Sequence, a_picture_never_takes_the_name_of_another)
{
    const Scratch scratch;
    const std::string name = (scratch / "my.hair").string();
    EXPECT_EQ(unused_name(name), name + "-001.png");
    scratch.write("my.hair-001.png", "");
    scratch.write("my.hair-003.png", "");
    EXPECT_EQ(unused_name(name + ".png"), name + "-002.png");
    EXPECT_EQ(unused_name("no/such/x"), "no/such/x-001.png");
    EXPECT_EQ(unused_name(name + ".hdr"), name + "-001.hdr");
}

TEST(Film, its_format_is_in_the_name)
{
    EXPECT_EQ(film_format("a.mp4"), "mp4");
    EXPECT_EQ(film_format("some/a.webm"), "webm");
    EXPECT_EQ(film_format("a.gif"), "gif");
    for (const char* other : {"a.png", "a", "mp4", ".gif", "a.mp4.png", ""})
        EXPECT_EQ(film_format(other), "") << other;
}

TEST(Film, its_command_is_words_that_no_shell_reads)
{
    const std::vector<std::string> words = film_command("mp4", "-a; rm 'b'.mp4.new", 640, 481, 23.976, false);
    EXPECT_EQ(words.front(), "ffmpeg");
    EXPECT_EQ(words.back(), "file:-a; rm 'b'.mp4.new");
    const auto after = [&](const char* word) { return *(std::ranges::find(words, word) + 1); };
    EXPECT_EQ(after("-video_size"), "640x481");
    EXPECT_EQ(after("-framerate"), "23.976");
    EXPECT_EQ(after("-i"), "pipe:0");
}

TEST(Film, ffmpeg_is_looked_for_in_the_path)
{
    const Scratch scratch;
    const std::string before = std::getenv("PATH");
    setenv("PATH", scratch.folder().c_str(), 1);
    EXPECT_FALSE(has_ffmpeg());
    fs::create_directories(scratch / "ffmpeg");
    EXPECT_FALSE(has_ffmpeg()) << "a folder is no program";
    fs::remove(scratch / "ffmpeg");
    scratch.write("ffmpeg", "#!/bin/sh\n");
    EXPECT_FALSE(has_ffmpeg()) << "nor is a file that cannot be run";
    fs::permissions(scratch / "ffmpeg", fs::perms::owner_all);
    EXPECT_TRUE(has_ffmpeg());
    setenv("PATH", before.c_str(), 1);
}

TEST(Sheet, cells_are_equal_in_order_and_apart)
{
    for (const int cells : {1, 2, 3, 5, 7, 10, 23, 100})
        for (const int columns : {0, 1, 3, 200})
        {
            const SheetLayout at = lay_out(cells, columns ? std::optional(columns) : std::nullopt, 64, 48);
            EXPECT_GE(at.columns * at.rows, cells);
            EXPECT_LT(at.columns * (at.rows - 1), cells) << "no empty row";
            EXPECT_LE(at.columns, cells);
            for (int i = 0; i < cells; ++i)
            {
                EXPECT_GE(at.x(i), at.gap);
                EXPECT_LE(at.x(i) + 64 + at.gap, at.width);
                EXPECT_LE(at.y(i) + 48 + at.label_height() + at.gap, at.height);
                const bool first_column = i % at.columns == 0, first_row = i < at.columns;
                EXPECT_EQ(at.x(i), first_column ? at.gap : at.x(i - 1) + 64 + at.gap);
                EXPECT_EQ(at.y(i), first_row ? at.gap : at.y(i - at.columns) + 48 + at.label_height() + at.gap);
            }
        }
    const auto columns = [](int cells) { return lay_out(cells, std::nullopt, 360, 360).columns; };
    EXPECT_EQ(columns(1), 1);
    EXPECT_EQ(columns(2), 2);
    EXPECT_EQ(columns(3), 3);
    EXPECT_EQ(columns(4), 2);
    EXPECT_EQ(columns(10), 5) << "no cell is left empty";
    EXPECT_EQ(columns(12), 4);
}

TEST(Sheet, what_cannot_be_held_is_refused_before_it_is_asked_for)
{
    for (const int bad : {0, -1, -1000000})
        EXPECT_NE(error_of([&] { lay_out(10, bad, 64, 64); }).find("--columns"), std::string::npos) << bad;
    EXPECT_NE(error_of([] { lay_out(2, std::nullopt, 8192, 8192); }).find("smaller --size"), std::string::npos);
    EXPECT_NE(error_of([] { lay_out(2000000000, std::nullopt, 8192, 8192); }).find("smaller"), std::string::npos);
    EXPECT_NE(error_of([] { lay_out(60000, 1, 1, 1); }).find("smaller"), std::string::npos) << "too high";
    EXPECT_EQ(error_of([] { lay_out(1, std::nullopt, 8000, 7000); }), "no error");
}

TEST(Sheet, labels_are_names_and_tell_equal_names_apart)
{
    EXPECT_EQ(sheet_labels({"bob", "some/wavy.toml", "a/x.toml", "b/x.toml", ""}),
              (std::vector<std::string>{"bob", "wavy", "a/x.toml", "b/x.toml", ""}));
}

TEST(Lettering, letters_cover_pixels_and_differ)
{
    const TextLine line = line_of("bob", 20, 1000), other = line_of("bod", 20, 1000);
    EXPECT_GT(line.width, 15);
    EXPECT_LT(line.width, 60);
    ASSERT_EQ(line.coverage.size(), size_t(line.width * line.height));
    EXPECT_GT(std::ranges::count_if(line.coverage, [](int c) { return c > 200; }), 30);
    EXPECT_NE(line.coverage, other.coverage);
    EXPECT_EQ(line.coverage, line_of("bob", 20, 1000).coverage);
    EXPECT_EQ(line_of("", 20, 1000).width, 0);
    EXPECT_GT(line_of("bob", 40, 1000).height, line.height);
}

TEST(Lettering, long_lines_end_in_dots_and_strange_letters_do_no_harm)
{
    const std::string name(500, 'w');
    for (const int most : {0, 1, 5, 20, 21, 100})
        EXPECT_LE(line_of(name, 20, most).width, most);
    EXPECT_EQ(line_of(name, 20, 100).coverage, line_of(name + "x", 20, 100).coverage);
    const TextLine line = line_of("a\n\xff\xc3\xa4\xf0\x9f\x92\x87\xe4\xb8\xad", 20, 1000);
    EXPECT_GT(line.width, 30);
    EXPECT_NE(line_of("\xc3\xa4", 20, 1000).coverage, line_of("a", 20, 1000).coverage) << "dots on an a";
}

TEST(Lettering, what_sticks_out_is_cut_off)
{
    Image image{8, 8, std::vector<unsigned char>(256, 10)};
    const TextLine block{20, 20, std::vector<unsigned char>(400, 255)};
    for (const auto& [x, y] : {std::pair(-30, 0), {0, -30}, {9, 9}, {8, 0}, {-20, -20}})
        write_line(image, block, x, y, {1, 2, 3});
    EXPECT_EQ(image.pixels, std::vector<unsigned char>(256, 10));
    write_line(image, block, -15, 6, {1, 2, 3});
    EXPECT_EQ(image.pixels[4 * (6 * 8 + 4) + 1], 2);
    EXPECT_EQ(image.pixels[4 * (6 * 8 + 5) + 1], 10);
    EXPECT_EQ(image.pixels[4 * (5 * 8 + 4) + 1], 10);
}

TEST(Pictures, a_camera_that_cannot_be_is_told_with_what_may_be_said)
{
    const auto told = [](const char* camera)
    {
        ShotOptions shot;
        shot.camera = camera;
        return error_of([&] { check_shot({}, shot); });
    };
    for (const char* good : {"", "front", "top", "25,5", "-360,89", "360,-89,0.02", "0,0,100"})
        EXPECT_EQ(told(good), "no error") << good;
    const std::pair<const char*, const char*> of_range[] = {
        {"400,0", "--camera 400,0: camera.yaw is 400, but must lie in [-360, 360] deg"},
        {"0,95", "--camera 0,95: camera.pitch is 95, but must lie in [-89, 89] deg"},
        {"0,0,500", "--camera 0,0,500: camera.distance is 500, but must lie in [0.02, 100] m"},
        {"0,0,0", "--camera 0,0,0: camera.distance is 0, but must lie in [0.02, 100] m"},
        {"0,nan", "--camera 0,nan: camera.pitch is nan, but must be a finite number"},
    };
    for (const auto& [camera, expected] : of_range)
        EXPECT_EQ(told(camera), expected);
    for (const char* camera : {"sideways", "25", "25,", "25,5,", "25,5,1,1", "25,5,1m", "25;5"})
        EXPECT_EQ(told(camera), std::string("--camera ") + camera +
                                    ": expected front, left, right, back, top, or yaw,pitch[,distance] in degrees and "
                                    "metres: as 25,5 or 25,5,0.95");
}

TEST(Pictures, a_place_that_cannot_be_written_is_told_before_the_work)
{
    const Scratch scratch;
    EXPECT_EQ(error_of([&] { check_folder(scratch / "a.png"); }), "no error");
    EXPECT_EQ(error_of([] { check_folder("a.png"); }), "no error");
    EXPECT_NE(error_of([&] { check_folder(scratch / "none/a.png"); }).find("is its folder there"), std::string::npos);
    EXPECT_NE(error_of([&] { check_folder(scratch.folder()); }).find("is a folder"), std::string::npos);
}

} // namespace
} // namespace coif
