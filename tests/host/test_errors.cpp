// What coif says to a broken style: the words are part of the program.
#include "sim/shown.h"
#include "sim/simulation.h"
#include "tests/host/scratch.h"

#include <algorithm>
#include <cmath>

#include <sys/stat.h>

namespace coif
{
namespace
{

using test::error_of;
using test::Scratch;

std::string told(const std::string& text)
{
    return error_of([&] { parse_hairstyle(text, "bob.toml"); });
}

std::string repeated(const std::string& text, int times)
{
    std::string all;
    for (int i = 0; i < times; ++i)
        all += text;
    return all;
}

TEST(BrokenStyle, is_told_with_file_line_column_and_what_would_be_right)
{
    const std::pair<std::string, std::string> cases[] = {
        {"[strand]\nlenght = 0.2\n",
         "bob.toml:2:1: no parameter is called 'strand.lenght'; the nearest is strand.length"},
        {"[hair]\nlength = 0.2\n", "bob.toml:2:1: no parameter is called 'hair.length'; the nearest is strand.length"},
        {"[forces]\nstretching = 1\n",
         "bob.toml:2:1: no parameter is called 'forces.stretching'; the nearest is solver.stretching"},
        {"length = 0.2\n", "bob.toml:1:10: expected a [group], found the key 'length'; did you mean strand.length?"},
        {"[[strand]]\nlength = 0.2\n",
         "bob.toml:1:1: expected a [group], found the key 'strand'; did you mean interpolation.strands?"},
        {"strand = 3\n",
         "bob.toml:1:10: expected a [group], found the key 'strand'; did you mean interpolation.strands?"},
        // Wrong types, of each kind.
        {"[strand]\nlength = \"long\"\n", "bob.toml:2:10: strand.length must be a number, not text"},
        {"[strand]\nlength = true\n", "bob.toml:2:10: strand.length must be a number, not true or false"},
        {"[strand]\nlength = [0.2]\n", "bob.toml:2:10: strand.length must be a number, not a list"},
        {"[strand]\nlength = 2024-02-30\n", "bob.toml:2:10: not valid TOML"},
        {"[strand]\nlength = 2024-02-28\n", "bob.toml:2:10: strand.length must be a number, not a date or time"},
        {"[strand]\nlength = 07:32:00\n", "bob.toml:2:10: strand.length must be a number, not a date or time"},
        {"[strand.length]\n", "bob.toml:1:1: strand.length must be a number, not a table"},
        {"[strand]\nlength = {}\n", "bob.toml:2:10: strand.length must be a number, not a table"},
        {"[strand]\nnodes = 16.0\n",
         "bob.toml:2:9: strand.nodes must be a whole number in [3, 64], without point or exponent, not 16.0"},
        {"[interpolation]\nstrands = 1e9\n", "bob.toml:2:11: interpolation.strands must be a whole number in "
                                             "[0, 200000], without point or exponent, not 1000000000.0"},
        {"[strand]\nnodes = nan\n",
         "bob.toml:2:9: strand.nodes must be a whole number in [3, 64], without point or exponent, not nan"},
        {"[strand]\nnodes = \"16\"\n", "bob.toml:2:9: strand.nodes must be a whole number in [3, 64], not text"},
        {"[forces]\nwind = 3\n", "bob.toml:2:8: forces.wind must be three numbers like [0.0, 1.0, 0.0], not a number"},
        {"[forces]\nwind = [1, 2]\n",
         "bob.toml:2:8: forces.wind must be three numbers like [0.0, 1.0, 0.0], not a list"},
        {"[forces]\nwind = [1, 2, 3, 4]\n",
         "bob.toml:2:8: forces.wind must be three numbers like [0.0, 1.0, 0.0], not a list"},
        {"[forces]\nwind = [1, 2, \"3\"]\n",
         "bob.toml:2:8: forces.wind must be three numbers like [0.0, 1.0, 0.0], not a list"},
        {"[look]\nwidth_along = [1, 0.5, 0]\n",
         "bob.toml:2:15: look.width_along must be four numbers from root to tip, like [1.0, 1.0, 0.5, 0.0], not 3"},
        {"[look]\nwidth_along = 1\n", "bob.toml:2:15: look.width_along must be four numbers from root to tip, like "
                                      "[1.0, 1.0, 0.5, 0.0], not a number"},
        {"[look]\nopacity_along = [1, 1, 1, 2]\n", "bob.toml:2:17: look.opacity_along is 2, but must lie in [0, 1]"},
        {"[look]\ntip_color = \"red\"\n",
         "bob.toml:2:13: look.tip_color must be a colour like \"#8a5a3c\" or three numbers from 0 to 1, not text"},
        {"[look]\ntip_color = \"#12345\"\n",
         "bob.toml:2:13: look.tip_color must be a colour like \"#8a5a3c\" or three numbers from 0 to 1, not text"},
        {"[look]\ntip_color = \"#12345g\"\n",
         "bob.toml:2:13: look.tip_color must be a colour like \"#8a5a3c\" or three numbers from 0 to 1, not text"},
        {"[look]\ntip_color = \"# 1 2 3\"\n",
         "bob.toml:2:13: look.tip_color must be a colour like \"#8a5a3c\" or three numbers from 0 to 1, not text"},
        {"[look]\ntip_color = 0xffffff\n",
         "bob.toml:2:13: look.tip_color must be a colour like \"#8a5a3c\" or three numbers from 0 to 1, not a number"},
        {"[look]\ntip_color = [255, 0, 0]\n", "bob.toml:2:13: look.tip_color is 255, but must lie in [0, 1]"},
        {"[smoothing]\ncurve = \"bezier\"\n",
         "bob.toml:2:9: smoothing.curve must be one of linear, cosine, cubic, catmull_rom"},
        {"[smoothing]\ncurve = 3\n", "bob.toml:2:9: smoothing.curve must be one of linear, cosine, cubic, catmull_rom"},
        {"[smoothing]\ncurve = \"Linear\"\n",
         "bob.toml:2:9: smoothing.curve must be one of linear, cosine, cubic, catmull_rom"},
        {"[scalp]\nmesh = 3\n", "bob.toml:2:8: scalp.mesh must be text in quotes, not a number"},
        {"[scalp]\nmesh = \"a\\u0000b\"\n", "bob.toml:2:8: scalp.mesh must not hold a zero byte"},
        // Numbers that will not do.
        {"[strand]\nlength = -1\n", "bob.toml:2:10: strand.length is -1, but must lie in [0.002, 1.5] m"},
        {"[strand]\nlength = nan\n", "bob.toml:2:10: strand.length is nan, but must be a finite number"},
        {"[strand]\nlength = inf\n", "bob.toml:2:10: strand.length is inf, but must be a finite number"},
        {"[strand]\nlength = -inf\n", "bob.toml:2:10: strand.length is -inf, but must be a finite number"},
        {"[strand]\nlength = 1e300\n", "bob.toml:2:10: strand.length is 1e+300, but must lie in [0.002, 1.5] m"},
        {"[forces]\nwind = [0, nan, 0]\n", "bob.toml:2:8: forces.wind is nan, but must be a finite number"},
        {"[interpolation]\nstrands = -1\n",
         "bob.toml:2:11: interpolation.strands is -1, but must be a whole number in [0, 200000]"},
        {"[interpolation]\nstrands = 9223372036854775807\n",
         "bob.toml:2:11: interpolation.strands is 9223372036854775807, but must be a whole number in [0, 200000]"},
        {"[strand]\nnodes = -9223372036854775808\n",
         "bob.toml:2:9: strand.nodes is -9223372036854775808, but must be a whole number in [3, 64]"},
        {"[strand]\nnodes = 4294967312\n",
         "bob.toml:2:9: strand.nodes is 4294967312, but must be a whole number in [3, 64]"},
        {"[strand]\nnodes = 65\n", "bob.toml:2:9: strand.nodes is 65, but must be a whole number in [3, 64]"},
        // Colliders.
        {"collider = 3\n", "bob.toml:1:12: collider must be written as [[collider]] tables"},
        {"[collider]\ncenter = [0, 0, 0]\nradius = 1\n",
         "bob.toml:1:1: collider must be written as [[collider]] tables"},
        {"collider = [3]\n", "bob.toml:1:13: collider must be written as [[collider]] tables"},
        {"[[collider]]\ncenter = [0, 0, 0]\n", "bob.toml:1:1: a collider needs center and radius"},
        {"[[collider]]\nradius = 1\n", "bob.toml:1:1: a collider needs center and radius"},
        {"[[collider]]\ncenter = [0, 0]\nradius = 1\n",
         "bob.toml:2:10: collider.center must be three numbers in metres"},
        {"[[collider]]\ncenter = [0, 0, 101]\nradius = 1\n",
         "bob.toml:2:10: collider.center is 101, but must lie in [-100, 100] m"},
        {"[[collider]]\ncenter = [0, nan, 0]\nradius = 1\n",
         "bob.toml:2:10: collider.center is nan, but must lie in [-100, 100] m"},
        {"[[collider]]\ncenter = [0, 0, 0]\nradius = 0\n",
         "bob.toml:3:10: collider.radius is 0, but must lie in [0.001, 100] m"},
        {"[[collider]]\ncenter = [0, 0, 0]\nradius = \"big\"\n",
         "bob.toml:3:10: collider.radius must be a number, not text"},
        {"[[collider]]\ncenter = [0, 0, 0]\nradius = 1\non = \"neck\"\n",
         "bob.toml:4:6: collider.on must be \"world\" or \"head\""},
        {"[[collider]]\ncenter = [0, 0, 0]\nradius = 1\nmass = 2\n",
         "bob.toml:4:8: a collider has no 'mass'; it has center, to, radius, on"},
        {"[[collider]]\ncenter = [0, 0, 0]\nradius = 1\nto = 2\n",
         "bob.toml:4:6: collider.to must be three numbers in metres"},
        {"[[collider]]\ncenter = [0, 0, 0]\nradius = 1\nto = [0, -101, 0]\n",
         "bob.toml:4:6: collider.to is -101, but must lie in [-100, 100] m"},
    };
    for (const auto& [text, expected] : cases)
        if (expected.ends_with("not valid TOML"))
            EXPECT_NE(told(text).find(": not valid TOML: "), std::string::npos) << text << "\n" << told(text);
        else
            EXPECT_EQ(told(text), expected) << text;
}

TEST(BrokenStyle, that_is_no_toml_is_told_with_its_place)
{
    const std::pair<std::string, std::string> cases[] = {
        {"[strand\nlength = 0.2\n", "bob.toml:1:8: not valid TOML: "},
        {"[strand]\nlength 0.2\n", "bob.toml:2:8: not valid TOML: "},
        {"[strand]\nlength = \n", "bob.toml:2:10: not valid TOML: "},
        {"[strand]\nlength = 0.2\nlength = 0.3\n", "bob.toml:3:"},
        {"[strand]\nlength = 0.2\n[strand]\nnodes = 16\n", "bob.toml:3:"},
        {"[scalp]\nmesh = \"open\n", "bob.toml:2:"},
        {"[strand]\nlength = 0.2 0.3\n", "bob.toml:2:14: not valid TOML: "},
        {"[strand]\nlength = 99999999999999999999\n", "bob.toml:2:"},
    };
    for (const auto& [text, begin] : cases)
    {
        EXPECT_EQ(told(text).rfind(begin, 0), 0u) << text << "\n" << told(text);
        EXPECT_NE(told(text).find("not valid TOML: "), std::string::npos) << told(text);
    }
}

TEST(BrokenStyle, bytes_that_are_no_text_are_told)
{
    std::mt19937 random(1);
    for (int trial = 0; trial < 200; ++trial)
    {
        std::string junk;
        for (int i = 0; i < 64; ++i)
            junk += char(random());
        EXPECT_EQ(told("a" + junk).rfind("bob.toml:", 0), 0u) << trial;
    }
    EXPECT_NE(told("[strand]\n# \xff\nlength = 0.2\n"), "no error");
    EXPECT_NE(told(std::string("[strand]\nlength = 0.2\n\0", 23)), "no error");
}

TEST(BrokenStyle, empty_files_marks_of_byte_order_and_windows_lines_are_none)
{
    for (const std::string text : {"", "\n", "# nothing\n", "\xEF\xBB\xBF", "[strand]\n", "collider = []\n"})
        EXPECT_EQ(told(text), "no error") << text;
    EXPECT_EQ(parse_hairstyle("\xEF\xBB\xBF[strand]\r\nlength = 0.5\r\n", "bob.toml").params.strand_length, 0.5f);
    EXPECT_EQ(told("\xEF\xBB\xBF[strand]\r\nlength = 5\r\n"),
              "bob.toml:2:10: strand.length is 5, but must lie in [0.002, 1.5] m");
    EXPECT_EQ(parse_hairstyle("strand.length = 1", "bob.toml").params.strand_length, 1.0f);
}

TEST(BrokenStyle, nested_beyond_reason_is_told_and_crashes_nothing)
{
    const int deep = 10000;
    EXPECT_EQ(told("a = " + repeated("[", deep)).rfind("bob.toml:1:", 0), 0u);
    EXPECT_EQ(told("a = " + repeated("[", deep) + repeated("]", deep)).rfind("bob.toml:1:", 0), 0u);
    EXPECT_EQ(told("a = " + repeated("{a=", deep)).rfind("bob.toml:1:", 0), 0u);
    EXPECT_NE(told("[" + repeated("a.", deep) + "a]\nb = 1\n"), "no error");
}

TEST(BrokenStyle, keys_of_a_million_dots_are_told_and_crash_nothing)
{
    const int deep = 1000000;
    EXPECT_NE(told(repeated("a.", deep) + "a = 1\n"), "no error");
    EXPECT_NE(told("[" + repeated("a.", deep) + "a]\n"), "no error");
    EXPECT_NE(told("[[" + repeated("a.", deep) + "a]]\n"), "no error");
    EXPECT_NE(told(repeated("'a' . ", deep / 4) + "a = 1\n"), "no error");
    EXPECT_NE(told("x = \"\"\"a\"b\"\"\"\n" + repeated("a.", deep) + "a = 1\n!"), "no error");
    const Scratch scratch;
    const fs::path file = scratch.write("deep.toml", repeated("a.", deep) + "a = 1\n");
    EXPECT_NE(error_of([&] { load_hairstyle(file); }), "no error");
    EXPECT_NE(error_of([&] { load_colliders(file); }), "no error");
    EXPECT_NE(error_of([&] { load_motion(file); }), "no error");
    Hairstyle style;
    EXPECT_NE(error_of([&] { assign(style, "strand.length={" + repeated("a.", deep) + "a = 1}"); }), "no error");
}

TEST(BrokenStyle, the_deepest_keys_that_are_let_through_crash_nothing)
{
    // As many dots as refuse_deep_keys() bears, in as many values in values as toml++ bears.
    const std::string level = "[\n{" + repeated("a.", 63) + "a = ";
    for (const char* end : {"1", "!"})
        EXPECT_NE(told(repeated("a.", 4000) + "a = " + repeated(level, 120) + end + repeated("}\n]", 120)), "no error");
    std::string colliders = "collider = [";
    for (int i = 0; i < 256; ++i)
        colliders += "{center = [0.25, -0.125, 1.5], radius = 0.001, on = 'head'}, ";
    EXPECT_EQ(parse_hairstyle(colliders + "]\n", "bob.toml").host.colliders.size(), 256u);
}

TEST(BrokenStyle, too_many_colliders_are_told_at_the_first_of_them)
{
    const std::string one = "[[collider]]\ncenter = [0, 0, 0]\nradius = 1\n";
    EXPECT_EQ(told(repeated(one, 256)), "no error");
    // It is the first that is too many that is in the way.
    EXPECT_EQ(told(repeated(one, 257)), "bob.toml:769:1: 257 colliders are more than the 256 that coif takes");
    EXPECT_EQ(told(repeated(one, 300)), "bob.toml:769:1: 300 colliders are more than the 256 that coif takes");
    EXPECT_EQ(told("collider = [\n" + repeated("{center = [0, 0, 0], radius = 1},\n", 258) + "]\n"),
              "bob.toml:258:1: 258 colliders are more than the 256 that coif takes");
}

TEST(BrokenStyle, too_many_of_any_list_are_told_at_the_first_of_them)
{
    const std::pair<const char*, std::string> lists[] = {
        {"regions", "[[region]]\nname = \"a{}\"\n"},
        {"partings", "[[parting]]\npoints = [[0, 0, 0], [0, 0, 1]]\n"},
        {"maps", "[[map]]\nof = \"strand.length\"\nvalues = [1]\n"},
        {"ties", "[[tie]]\nname = \"a\"\n"},
        {"lights", "[[light]]\ndirection = [0, 1, 0]\n"},
    };
    for (const auto& [name, one] : lists)
    {
        const size_t most = name == std::string("lights") ? kMostLights : 64,
                     lines = size_t(std::ranges::count(one, '\n'));
        std::string text = "[strand]\nlength = 0.2\n";
        for (size_t i = 0; i < most + 2; ++i)
            text += fmt::format(fmt::runtime(one), i);
        EXPECT_EQ(told(text), fmt::format("bob.toml:{}:1: {} {} are more than the {} that coif takes", 3 + most * lines,
                                          most + 2, name, most));
    }
    std::string variants; // whose order in the file is not that of their names
    for (int i = 0; i < 66; ++i)
        variants += fmt::format("[variant.v{}]\nstrand.length = 0.2\n", 99 - i);
    EXPECT_EQ(told(variants), "bob.toml:129:1: 66 variants are more than the 64 that coif takes");
    EXPECT_EQ(told("[[parting]]\npoints = [\n" + repeated("[0, 0, 0],\n[0, 0, 1],\n", 129) + "]\n"),
              "bob.toml:259:1: parting.points must be 2 to 256 points, not 258");
}

TEST(BrokenStyle, a_file_that_is_none_is_told)
{
    const Scratch scratch;
    EXPECT_EQ(error_of([&] { load_hairstyle(scratch.folder()); }),
              scratch.folder().string() + ": is a folder, not a regular file; name a file in it");
    EXPECT_EQ(error_of([&] { load_hairstyle(scratch / "none.toml"); }),
              (scratch / "none.toml").string() + ": there is no such file");
    const fs::path large = scratch.write("large.toml", "#" + std::string(5 << 20, 'x'));
    EXPECT_EQ(error_of([&] { load_hairstyle(large); }),
              large.string() + ": is larger than the 4194304 bytes that coif reads of such a file");
    const fs::path long_key = scratch.write("key.toml", std::string(3 << 20, 'k') + " = 1\n");
    EXPECT_NE(error_of([&] { load_hairstyle(long_key); }), "no error");
}

TEST(BrokenStyle, what_never_ends_or_never_begins_is_read_by_none_and_told_where_the_style_names_it)
{
    const test::TimeLimit limit(20);
    const Scratch scratch;
    ASSERT_EQ(mkfifo((scratch / "pipe").c_str(), 0600), 0);
    fs::create_directory(scratch / "folder");
    const std::string pipe = (scratch / "pipe").string(), folder = (scratch / "folder").string();
    const std::pair<std::string, std::string> files[] = {
        {pipe, pipe + ": is a pipe, not a regular file; write what it gives into a file and name that"},
        {folder, folder + ": is a folder, not a regular file; name a file in it"},
        {"/dev/zero", "/dev/zero: is a device, not a regular file; write what it gives into a file and name that"},
    };
    const std::pair<std::string, std::string> keys[] = {
        {"[scalp]\nmesh = ", ":2:8: "},
        {"[head]\nmesh = ", ":2:8: "},
        {"[head]\nspheres = ", ":2:11: "},
        {"[look]\nlights = ", ":2:10: "},
        {"[groom]\nimport = ", ":2:10: "},
        {"[groom]\nrest = ", ":2:8: "},
        {"[[region]]\nname = 'a'\n[[region]]\nname = 'b'\nfile = ", ":5:8: "},
        {"[[map]]\nof = 'strand.length'\nfile = ", ":3:8: "},
    };
    const std::string bob = (scratch / "bob.toml").string();
    for (const auto& [file, fault] : files)
    {
        for (const auto& [key, place] : keys)
        {
            scratch.write("bob.toml", key + "'" + file + "'\n");
            EXPECT_EQ(error_of([&] { load_assets(load_hairstyle(bob)); }), bob + place + fault);
        }
        EXPECT_EQ(error_of([&, f = file] { load_hairstyle(f); }), fault);
        EXPECT_EQ(error_of([&, f = file] { load_motion(f); }), fault);
        EXPECT_EQ(error_of([&, f = file] { load_mesh(f); }), fault);
    }
    if (const fs::path passes = "/proc/self/pagemap"; fs::is_regular_file(passes)) // terabytes, in no bytes
    {
        EXPECT_EQ(error_of([&] { load_hairstyle(passes); }),
                  passes.string() + ": is larger than the 4194304 bytes that coif reads of such a file");
        EXPECT_EQ(error_of([&] { load_mesh(passes); }),
                  passes.string() + ": is no mesh that coif can read: it is empty");
    }
    scratch.write("bob.toml", "[[map]]\nof = 'strand.length'\nfile = 'none.map'\n");
    EXPECT_EQ(error_of([&] { load_hairstyle(bob); }),
              bob + ":3:8: " + (scratch / "none.map").string() + ": there is no such file");
}

TEST(BrokenStyle, a_named_file_that_is_missing_or_broken_is_told_where_the_style_names_it)
{
    const Scratch scratch;
    const auto loaded = [&](const std::string& text)
    {
        const Hairstyle style = load_hairstyle(scratch.write("bob.toml", text));
        return error_of([&] { load_assets(style); });
    };
    const std::string bob = (scratch / "bob.toml").string();
    EXPECT_EQ(loaded(""), "no error");
    EXPECT_EQ(loaded("[interpolation]\nrefine = 5\n").rfind(bob + ":2:10: interpolation.refine: 5 would give more", 0),
              0u);
    EXPECT_EQ(loaded("[head]\nmesh = '/'\n"), bob + ":2:8: /: is a folder, not a regular file; name a file in it");
    scratch.write("giant.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\nf 1 2 3\n");
    EXPECT_NE(loaded("[head]\nmesh = 'giant.obj'\n").find("is further than 1000000 from the origin"),
              std::string::npos);
    EXPECT_EQ(
        loaded("\n[head]\nmesh = 'none.obj'\n").rfind(bob + ":3:8: head.mesh: no file 'none.obj', neither as ", 0), 0u);
    EXPECT_EQ(
        loaded("[scalp]\nmesh = 'none.obj'\n").rfind(bob + ":2:8: scalp.mesh: no file 'none.obj', neither as ", 0), 0u);
    EXPECT_EQ(loaded("[scalp]\nmesh = ''\n"), bob + ":2:8: scalp.mesh must name an OBJ");
    const std::string quad = scratch.write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 2 3 4\n").string();
    EXPECT_EQ(loaded("[scalp]\nmesh = 'quad.obj'\n"),
              bob + ":2:8: " + quad +
                  ":5: a scalp must be triangles, but this face has 4 corners; triangulate it on export");
    const std::string spheres = scratch.write("s.toml", "[[collider]]\ncenter = [0,0,0]\n").string();
    EXPECT_EQ(loaded("[head]\nspheres = 's.toml'\n"),
              bob + ":2:11: " + spheres + ":1:1: a collider needs center and radius");
    scratch.write("s.toml", "[strand]\nlength = 1\n");
    EXPECT_EQ(loaded("[head]\nspheres = 's.toml'\n"),
              bob + ":2:11: " + spheres + ":1:2: expected [[collider]] tables only, found 'strand'");
    const std::string junk = scratch.write("junk.ply", "junk").string();
    EXPECT_EQ(
        loaded("[head]\nmesh = 'junk.ply'\n").rfind(bob + ":2:8: " + junk + ": is no mesh that coif can read: ", 0),
        0u);
    fs::create_directory(scratch / "folder");
    EXPECT_NE(loaded("[head]\nmesh = 'folder'\n"), "no error");
    EXPECT_NE(loaded("[scalp]\nmesh = 'folder'\n"), "no error");
    EXPECT_EQ(loaded("[head]\nmesh = ''\nspheres = ''\n"), "no error");
}

// Bytes of one letter each, in UTF-8, none of which does anything in a terminal but to show?
bool prints(const std::string& text)
{
    for (size_t i = 0; i < text.size();)
    {
        const auto byte = [&](size_t at) { return at < text.size() ? int(static_cast<unsigned char>(text[at])) : 0; };
        const size_t length = byte(i) < 0x80 ? 1 : byte(i) < 0xe0 ? 2 : byte(i) < 0xf0 ? 3 : 4;
        if (byte(i) < 0x20 || byte(i) == 0x7f || (byte(i) >= 0x80 && byte(i) < 0xc2) || byte(i) >= 0xf5 ||
            (byte(i) == 0xc2 && byte(i + 1) < 0xa0))
            return false;
        for (size_t k = 1; k < length; ++k)
            if ((byte(i + k) & 0xc0) != 0x80)
                return false;
        i += length;
    }
    return true;
}

TEST(LongTexts, are_told_by_their_beginnings_wherever_a_file_says_them)
{
    const Scratch scratch;
    // Letters of one, two and four bytes, so that no cut by bytes passes, and what moves a terminal's cursor.
    std::string text;
    for (int i = 0; i < 5000; ++i)
        text += "a\xc3\xa9\xf0\x9f\xa6\xb1\\u001b[2J\\u009b";
    const std::string q = '"' + text + '"'; // as key and as value
    const std::string of_styles[] = {
        "[" + q + "]\nlength = 1\n",
        q + " = 1\n",
        "[strand]\n" + q + " = 1\n",
        "[strand]\nlength = 1\n[strand]\n" + q + " = 1\n",
        "[" + q + "]\n[" + q + "]\n",
        "[[collider]]\n" + q + " = 1\ncenter = [0, 0, 0]\nradius = 1\n",
        "[[region]]\nname = \"a\"\nwhere = " + q + "\n",
        "[[region]]\nname = \"a\"\nstrand." + q + " = 1\n",
        "[[region]]\nname = " + q + "\n[[region]]\nname = " + q + "\n",
        "[[region]]\nname = " + q + "\nplanes = [[0, 1, 0, 50]]\n",
        "[[region]]\nname = " + q + "\ngroup = " + q + "\n",
        "[[region]]\nname = " + q + "\nweights = [1]\n",
        "[[region]]\nname = \"a\"\nfile = " + q + "\n",
        "[[map]]\nof = " + q + "\nvalues = [1]\n",
        "[[map]]\nof = \"strand.length\"\nfile = " + q + "\n",
        "[[tie]]\nname = " + q + "\nregions = " + q + "\n",
        "[[light]]\nname = " + q + "\n",
        "[variant." + q + "]\n" + q + " = 1\n",
        "[variant.a]\nstrand." + q + " = 1\n",
        "[groom]\nrest = " + q + "\n",
        "[groom]\nimport = " + q + "\n",
        "[scalp]\nmesh = " + q + "\n",
        "[head]\nmesh = " + q + "\n",
        "[head]\nspheres = " + q + "\n",
        "[look]\nlights = " + q + "\n",
    };
    const auto expect_short = [](const std::string& told, const std::string& input)
    {
        EXPECT_NE(told, "no error") << input.substr(0, 60);
        EXPECT_LT(told.size(), 1200u) << input.substr(0, 60);
        EXPECT_TRUE(prints(told)) << input.substr(0, 60);
    };
    for (const std::string& style : of_styles)
        expect_short(error_of([&] { load_assets(load_hairstyle(scratch.write("bob.toml", style))); }), style);
    for (const std::string& lights : {q + " = 1\n", "[sky]\nradiance = 1\n" + q + " = 1\n"})
        expect_short(error_of([&] { load_lights(scratch.write("l.toml", lights)); }), lights);
    expect_short(error_of([&] { load_colliders(scratch.write("c.toml", q + " = 1\n")); }), "colliders");
    for (const std::string& motion :
         {q + " = 1\n", "[[step]]\nchannel = \"x\"\nat = 0\nby = 1\n" + q + " = 1\n", "[" + q + "]\n[" + q + "]\n"})
        expect_short(error_of([&] { load_motion(scratch.write("m.toml", motion)); }), motion);
    const std::string raw = repeated("a\x1b[2J\xc2\x9b\xff\n", 5000); // as an argument may be
    Hairstyle style;
    style.variants[raw] = {};
    for (const std::string& set : {raw, raw + "=1", "strand.length=" + raw, "strand.length=1 " + raw})
        expect_short(error_of([&] { assign(style, set); }), "--set");
    expect_short(error_of([&] { switch_variant(style, raw + "x"); }), "--variant");
    expect_short(error_of([&] { find_motion(raw); }), "--motion");
    expect_short(error_of([&] { load_hairstyle(raw); }), "STYLE");
}

TEST(LongTexts, end_in_dots_after_eighty_letters_of_however_many_bytes)
{
    EXPECT_EQ(shown(""), "");
    EXPECT_EQ(shown(std::string(80, 'k')), std::string(80, 'k'));
    EXPECT_EQ(shown(std::string(81, 'k')), std::string(80, 'k') + "...");
    EXPECT_EQ(shown(repeated("\u00e9", 80)), repeated("\u00e9", 80));
    EXPECT_EQ(shown(repeated("\U0001f9b1", 81)), repeated("\U0001f9b1", 80) + "...");
    EXPECT_EQ(shown("two\nlines\t\x1b[2J\x7f"), "two\\nlines\\u0009\\u001b[2J\\u007f");
    EXPECT_EQ(shown("\u009b \u202e"), "\\u009b \\u202e") << "a terminal's escape in one letter, and writing backwards";
    for (const auto& [bytes, expected] : {std::pair("\xff", "\\xff"),
                                          {"\xc3", "\\xc3"},
                                          {"\xc0\xaf", "\\xc0\\xaf"},
                                          {"\xed\xa0\x80", "\\xed\\xa0\\x80"},
                                          {"\xc3(", "\\xc3("}})
        EXPECT_EQ(shown(bytes), expected) << "which is no UTF-8";

    const std::string deep = "/" + repeated("folder/", 12) + "bob.toml"; // such as people have
    EXPECT_EQ(shown_file(deep), deep);
    const std::string hostile = shown_file("begin" + std::string(1 << 20, 'x') + "\u00e9/end.obj");
    EXPECT_TRUE(hostile.starts_with("beginxxx") && hostile.ends_with("xxx\u00e9/end.obj")) << hostile;
    EXPECT_EQ(hostile.size(), 80u + 3u + 80u);
    EXPECT_TRUE(prints(shown_file(std::string(100, 'x') + repeated("\u00e9", 100))));
}

TEST(BrokenScalp, is_told_with_its_line)
{
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 0 1\n";
    const std::pair<std::string, std::string> cases[] = {
        {"", ":1: a scalp needs at least three vertices (v x y z) and a triangle (f a b c)"},
        {"Dear reader,\nthis is no mesh.\n",
         ":1: a scalp needs at least three vertices (v x y z) and a triangle (f a b c)"},
        {corners, ": a scalp needs triangles (f a b c), but has none"},
        {corners + "v 1 0 1\n# quad\nf 1 2 4 3\n",
         ":6: a scalp must be triangles, but this face has 4 corners; triangulate it on export"},
        {corners + "f 1 2 3\nf 1 2\nf 1 3 2\n",
         ":5: a scalp must be triangles, but this face has 2 corners; triangulate it on export"},
        {corners + "f 1 2 3\nf" + repeated(" 1 2 3", 87) + repeated(" 1", 2) + "\n",
         ":5: a scalp must be triangles, but this face has 263 corners; triangulate it on export"},
        {corners + "f" + repeated(" 1 2 3", 86) + " 1\n",
         ":4: a scalp must be triangles, but this face has 259 corners; triangulate it on export"},
        {corners + "f 1 2 3\n\nf 1 2 9\n", ":6: this face names vertex 9, but there are 3"},
        {corners + "f 1 2 2147483647\n", ":4: this face names vertex 2147483647, but there are 3"},
        {corners + "f 1 2 -9\n", ":4: this face names vertex -9, but there are 3"},
        {corners + "f 0 1 2\n", ":4: this face names vertex 0, but there are 3"},
        {corners + "f 1 2 x\n", ":4: a face must name three vertices by number"},
        {corners + "f 1 2 99999999999999\n", ":4: a face must name three vertices by number"},
        {"v 0 0 0\nv 1 nan 0\nv 0 0 1\nf 1 2 3\n", ":2: a vertex must be three finite numbers within 10 km, in metres"},
        {"v 0 0 0\nv 1 inf 0\nv 0 0 1\nf 1 2 3\n", ":2: a vertex must be three finite numbers within 10 km, in metres"},
        {"v 0 0 0\nv 1 1e300 0\nv 0 0 1\nf 1 2 3\n",
         ":2: a vertex must be three finite numbers within 10 km, in metres"},
        {"v 0 0 0\nv 20000 0 0\nv 0 0 1\nf 1 2 3\n",
         ":2: a vertex must be three finite numbers within 10 km, in metres"},
        {"v 0 0 0\nv 1 zero 0\nv 0 0 1\nf 1 2 3\n",
         ":2: a vertex must be three finite numbers within 10 km, in metres"},
        {"v 0 0 0\nv 1 0\nv 0 0 1\nf 1 2 3\n", ":2: a vertex must be three finite numbers within 10 km, in metres"},
        {"v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n", ": all vertices of the scalp lie in one place"},
        {corners + "f 1 2 3\nt x 2000000000/2000000000/2000000000 1\nt y -1/-1/-1\n", "no error"},
    };
    const Scratch scratch;
    for (const auto& [text, expected] : cases)
    {
        const fs::path file = scratch.write("scalp.obj", text);
        EXPECT_EQ(error_of([&] { load_scalp(file); }), (expected == "no error" ? "" : file.string()) + expected)
            << text.substr(0, 200);
    }
}

TEST(BrokenScalp, one_cut_short_is_told)
{
    const Scratch scratch;
    const std::string whole = test::bytes_of(test::shipped("scalp.obj"));
    const fs::path half =
        scratch.write("half.obj", whole.substr(0, whole.size() / 2)); // amid the faces or the vertices
    EXPECT_NE(error_of([&] { load_scalp(half); }), "no error");
    // Amid the last face: the second corner stays.
    const fs::path last = scratch.write("last.obj", whole.substr(0, whole.find_last_of(' ')));
    EXPECT_NE(error_of([&] { load_scalp(last); }).find("this face has 2 corners"), std::string::npos);
}

TEST(BrokenScalp, more_guides_than_coif_takes_are_told)
{
    std::string text;
    for (int i = 0; i < 65537; ++i)
        text += i % 2 ? "v 1 0 0\n" : "v 0 0 1\n";
    const Scratch scratch;
    const fs::path file = scratch.write("dense.obj", text + "f 1 2 3\n");
    EXPECT_EQ(error_of([&] { load_scalp(file); }),
              file.string() + ": 65537 vertices are more guides than the 65536 that coif takes");
}

TEST(Assignment, takes_toml_values_and_bare_words)
{
    Hairstyle style;
    for (const char* good :
         {"strand.length=0.2", "strand.nodes=20", "strand.nodes= 20", "forces.wind=[1, 2, 3]", "look.tip_color=#8a5a3c",
          "look.tip_color=\"#8a5a3c\"", "look.root_color=[0, 0.5, 1]", "smoothing.curve=linear",
          "smoothing.curve=\"linear\"", "scalp.mesh=my file.obj", "head.mesh=", "head.spheres=\"a=b.toml\""})
        EXPECT_EQ(error_of([&] { assign(style, good); }), "no error") << good;
    EXPECT_EQ(style.params.strand_length, 0.2f);
    EXPECT_EQ(style.params.strand_nodes, 20);
    EXPECT_EQ(style.params.forces_wind, F4(1, 2, 3, 0));
    EXPECT_EQ(style.params.look_tip_color.x, float(0x8a / 255.0));
    EXPECT_EQ(style.params.smoothing_curve, 0);
    EXPECT_EQ(style.host.scalp_mesh, "my file.obj");
    EXPECT_EQ(style.host.head_mesh, "");
    EXPECT_EQ(style.host.head_spheres, "a=b.toml");
    EXPECT_EQ(style.places.at("scalp.mesh"), "--set scalp.mesh");
}

TEST(Assignment, that_will_not_do_is_told_and_changes_nothing)
{
    const std::pair<const char*, const char*> cases[] = {
        {"strand.length", "--set strand.length: expected group.key=value"},
        {"", "--set : expected group.key=value"},
        {"strand.lenght=1",
         "--set strand.lenght=1: no parameter is called 'strand.lenght'; the nearest is strand.length"},
        {"strand.length=", "--set strand.length=: strand.length must be a number, not text"},
        {"strand.length=long",
         "--set strand.length=long: 'long' is no TOML value; write it as 0.25, which is the default"},
        {"strand.length=0.2\n[x]", "--set strand.length=0.2\\n[x]: '0.2\\n[x]' is more than one TOML value"},
        {"strand.length=-1", "--set strand.length=-1: strand.length is -1, but must lie in [0.002, 1.5] m"},
        {"strand.length=nan", "--set strand.length=nan: strand.length is nan, but must be a finite number"},
        {"strand.nodes=2.5",
         "--set strand.nodes=2.5: strand.nodes must be a whole number in [3, 64], without point or exponent, not 2.5"},
        {"smoothing.curve=round",
         "--set smoothing.curve=round: smoothing.curve must be one of linear, cosine, cubic, catmull_rom"},
        {"look.tip_color=#12",
         "--set look.tip_color=#12: look.tip_color must be a colour like \"#8a5a3c\" or three numbers "
         "from 0 to 1, not text"},
        {"forces.wind=[1, 2",
         "--set forces.wind=[1, 2: '[1, 2' is no TOML value; write it as [0.0, 0.0, 0.0], which is the default"},
        {"collider=3", "--set collider=3: collider must be a list of [[collider]] tables, not a number"},
        {"scalp.mesh=\"open",
         "--set scalp.mesh=\"open: '\"open' is no TOML value; write it as \"scalp.obj\", which is the default"},
    };
    for (const auto& [assignment, expected] : cases)
    {
        Hairstyle style;
        EXPECT_EQ(error_of([&] { assign(style, assignment); }), expected);
        EXPECT_TRUE(style.places.empty());
        EXPECT_EQ(style.host, HostParams{});
        EXPECT_EQ(style.params.strand_length, HairParams{}.strand_length);
    }
}

TEST(Assignment, a_text_that_is_no_utf8_cannot_be_saved_and_harms_nothing)
{
    const Scratch scratch;
    const fs::path file = scratch.write("bob.toml", "[strand]\nlength = 0.2\n");
    Hairstyle style = load_hairstyle(file);
    assign(style, "head.mesh=\xff\xfe.obj");
    EXPECT_NE(error_of([&] { save_hairstyle(style, file); }), "no error");
    EXPECT_EQ(test::bytes_of(file), "[strand]\nlength = 0.2\n");
}

} // namespace
} // namespace coif
