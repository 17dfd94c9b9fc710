// Hairstyle files: what a save writes, keeps and replaces.
#include "sim/hairstyle.h"
#include "sim/hairstyle_lists.h"
#include "tests/host/entries.h"
#include "tests/host/scratch.h"

#include <cmath>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace coif
{
namespace
{

using test::between;
using test::bytes_of;
using test::error_of;
using test::Scratch;

const char* const kTexts[] = {"",
                              "plain.obj",
                              "with \"quotes\" and 'single' ones",
                              "back\\slash\\n",
                              "H\xc3\xa4nde/\xe9\xab\xaa.obj \xf0\x9f\x92\x87",
                              "tab\tnew\nline\r\x01\x7f",
                              "# no comment",
                              "trailing space ",
                              "\"\"\"",
                              "#8a5a3c"};

// Every parameter at a random value of its range, colours half the time bytes; the same for the same seed.
Hairstyle random_style(unsigned seed)
{
    std::mt19937 random(seed);
    Hairstyle style;
    for (const ParamInfo& info : param_table())
    {
        if (info.kind == Kind::TEXT)
            *reinterpret_cast<std::string*>(reinterpret_cast<char*>(&style.host) + info.offset) =
                kTexts[random() % std::size(kTexts)];
        else if (info.kind == Kind::LIST)
            for (unsigned i = random() % 4; i > 0; --i)
                test::add_entry(style, info, random);
        else if (info.kind == Kind::SHAPE)
            continue; // a file of its own
        else
        {
            double v[kMostNumbers];
            const bool bytes = random() % 2 == 0;
            for (double& x : v)
            {
                const unsigned end = random() % 8; // often enough at an end
                x = end == 0 ? info.min : end == 1 ? info.max : double(float(between(random, info.min, info.max)));
                x = std::min(x, double(info.max));
                if (info.kind == Kind::INT || info.kind == Kind::CHOICE)
                    x = std::floor(x);
                if (info.kind == Kind::COLOR && bytes)
                    x = float(double(random() % 256) / 255.0);
            }
            set_numbers(style.params, info, v);
        }
    }
    return style;
}

void expect_same(const Hairstyle& a, const Hairstyle& b)
{
    for (const ParamInfo& info : param_table())
    {
        EXPECT_TRUE(same_value(a, b, info)) << info.path();
        if (info.on_host())
            continue;
        float va[kMostNumbers], vb[kMostNumbers];
        get_numbers(a.params, info, va);
        get_numbers(b.params, info, vb);
        EXPECT_EQ(memcmp(va, vb, size_t(info.components()) * sizeof(float)), 0)
            << info.path() << " " << va[0] << " " << vb[0];
    }
    EXPECT_EQ(a.host, b.host);
}

std::vector<std::string> lines_of(const std::string& text)
{
    std::vector<std::string> lines;
    for (size_t begin = 0; begin < text.size();)
    {
        const size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
        lines.push_back(text.substr(begin, end - begin));
        begin = end;
    }
    return lines;
}

TEST(Hairstyle, one_that_differs_in_nothing_writes_nothing)
{
    EXPECT_EQ(hairstyle_text({}, "new.toml"), "");
    const Scratch scratch;
    Hairstyle style;
    save_hairstyle(style, scratch / "new.toml");
    EXPECT_EQ(bytes_of(scratch / "new.toml"), "");
    expect_same(load_hairstyle(scratch / "new.toml"), {});
}

TEST(Hairstyle, only_what_differs_is_written)
{
    Hairstyle style;
    assign(style, "strand.length=0.2");
    assign(style, "look.tip_color=#8a5a3c");
    assign(style, "smoothing.curve=linear");
    EXPECT_EQ(hairstyle_text(style, "new.toml"),
              "[strand]\nlength = 0.2\n\n[look]\ntip_color = \"#8a5a3c\"\n\n[smoothing]\ncurve = \"linear\"\n");
    style.host.colliders = {{{0.0f, 0.1f, -2.5f}, 0.05f, true},
                            {{1.0f, 2.0f, 3.0f}, 1.0f, false, glm::vec3(1.0f, 2.5f, 3.0f)}};
    Hairstyle only_colliders;
    only_colliders.host.colliders = style.host.colliders;
    EXPECT_EQ(hairstyle_text(only_colliders, "new.toml"),
              "[[collider]]\ncenter = [0.0, 0.1, -2.5]\nradius = 0.05\non = \"head\"\n\n"
              "[[collider]]\ncenter = [1.0, 2.0, 3.0]\nto = [1.0, 2.5, 3.0]\nradius = 1.0\n");
}

TEST(Hairstyle, every_value_comes_back_from_a_file_bit_for_bit)
{
    const Scratch scratch;
    for (unsigned seed = 0; seed < 40; ++seed)
    {
        const Hairstyle wanted = random_style(seed);
        Hairstyle style = wanted;
        save_hairstyle(style, scratch / "random.toml");
        expect_same(style, wanted);
        const Hairstyle loaded = load_hairstyle(scratch / "random.toml");
        expect_same(loaded, wanted);
        EXPECT_EQ(hairstyle_text(loaded, scratch / "random.toml"), loaded.text); // and then nothing is left to write
        if (HasFailure())
            FAIL() << "seed " << seed << "\n" << style.text;
    }
}

TEST(Hairstyle, one_style_can_be_saved_over_any_other)
{
    const Scratch scratch;
    for (unsigned seed = 0; seed < 20; ++seed)
    {
        Hairstyle old = random_style(100 + seed);
        save_hairstyle(old, scratch / "over.toml");
        const Hairstyle wanted = random_style(200 + seed);
        for (const ParamInfo& info : param_table())
            copy_value(wanted, old, info);
        save_hairstyle(old, scratch / "over.toml");
        expect_same(load_hairstyle(scratch / "over.toml"), wanted);
    }
}

const std::string kCommented = "# Bob: short and blunt\n"
                               "\n"
                               "  [strand]   # what it is made of\n"
                               "length   =  0.20   # metres\n"
                               "\tnodes=16# a tab, and no space\n"
                               "\n"
                               "# one sphere\n"
                               "[[collider]]\n"
                               "radius = 0.1  # fist\n"
                               "center = [ 0, 1,\n"
                               "           2 ]\n"
                               "\n"
                               "[look]\n"
                               "root_color = '#101010' # nearly black\n"
                               "tip_color  = [0.5, 0.25, 0.125]\n"
                               "# the end, without a newline";

TEST(Hairstyle, a_save_keeps_every_line_that_did_not_change)
{
    const Scratch scratch;
    for (const bool crlf : {false, true})
    {
        std::string text = kCommented;
        for (size_t at = 0; crlf && (at = text.find('\n', at)) != text.npos; at += 2)
            text.replace(at, 1, "\r\n");
        const fs::path file = scratch.write("bob.toml", text);
        Hairstyle style = load_hairstyle(file);
        save_hairstyle(style, file);
        EXPECT_EQ(bytes_of(file), text); // nothing changed
        assign(style, "strand.nodes=20");
        assign(style, "look.root_color=#202020");
        save_hairstyle(style, file);
        const std::vector<std::string> before = lines_of(text), after = lines_of(bytes_of(file));
        ASSERT_EQ(before.size(), after.size());
        const std::string end = crlf ? "\r\n" : "\n";
        for (size_t i = 0; i < before.size(); ++i)
            EXPECT_EQ(after[i], i == 4    ? "\tnodes=20# a tab, and no space" + end
                                : i == 13 ? "root_color = \"#202020\" # nearly black" + end
                                          : before[i]);
    }
}

TEST(Hairstyle, a_value_set_back_to_its_default_is_written_where_it_stood)
{
    const Scratch scratch;
    const fs::path file = scratch.write("bob.toml", kCommented);
    Hairstyle style = load_hairstyle(file);
    copy_value({}, style, *find_param("strand.length"));
    save_hairstyle(style, file);
    EXPECT_EQ(load_hairstyle(file).params.strand_length, HairParams{}.strand_length);
    EXPECT_NE(bytes_of(file).find("length   =  0.25   # metres"), std::string::npos);
}

TEST(Hairstyle, colliders_are_added_changed_and_removed)
{
    const Scratch scratch;
    const fs::path file = scratch.write("bob.toml", kCommented);
    Hairstyle style = load_hairstyle(file);
    const Collider first{{0, 1, 2}, 0.1f, false};
    EXPECT_EQ(style.host.colliders, std::vector<Collider>{first});
    const auto saved = [&](std::vector<Collider> colliders)
    {
        style.host.colliders = colliders;
        save_hairstyle(style, file);
        EXPECT_EQ(load_hairstyle(file).host.colliders, colliders);
        EXPECT_EQ(style.host.colliders, colliders);
        EXPECT_NE(bytes_of(file).find("length   =  0.20   # metres"), std::string::npos);
        return bytes_of(file);
    };
    EXPECT_NE(saved({first, {{-1, 0.5f, 0}, 2.0f, true}}).find("radius = 0.1  # fist"), std::string::npos);
    EXPECT_NE(saved({{{0, 1, 2}, 0.3f, true}, {{-1, 0.5f, 0}, 2.0f, true}}).find("radius = 0.3  # fist"),
              std::string::npos);
    saved({{{0, 1, 2}, 0.3f, false}}); // no longer on the head
    EXPECT_NE(saved({{{0, 1, 2}, 0.3f, false, glm::vec3(0, 2, 2)}}).find("to = [0.0, 2.0, 2.0]"), std::string::npos);
    EXPECT_EQ(saved({{{0, 1, 2}, 0.3f, false}}).find("to = "), std::string::npos); // a sphere again
    EXPECT_EQ(saved({}).find("[[collider]]"), std::string::npos);
    saved({first, first, first});
}

TEST(Hairstyle, a_relative_path_is_rewritten_for_where_the_style_is_saved)
{
    const Scratch scratch;
    scratch.write("heads/mine.obj", "v 0 0 0\n");
    const fs::path file = scratch.write("styles/bob.toml", "[scalp]\nmesh = \"../heads/mine.obj\" # mine\n"
                                                           "[head]\nmesh = \"head.obj\"\n");
    fs::create_directories(scratch / "deep/er");
    Hairstyle style = load_hairstyle(file);
    save_hairstyle(style, scratch / "deep/er/bob.toml");
    EXPECT_EQ(bytes_of(scratch / "deep/er/bob.toml"), "[scalp]\nmesh = \"../../heads/mine.obj\" # mine\n"
                                                      "[head]\nmesh = \"head.obj\"\n"); // what coif ships stays
    EXPECT_EQ(style.host.scalp_mesh, "../../heads/mine.obj");
    EXPECT_EQ(style.file, scratch / "deep/er/bob.toml");
    save_hairstyle(style, scratch / "heads/bob.toml");
    EXPECT_EQ(style.host.scalp_mesh, "mine.obj");
    EXPECT_TRUE(fs::exists(resolve_path(style, "scalp.mesh", style.host.scalp_mesh, "/nowhere")));
}

TEST(Hairstyle, a_relative_path_is_right_where_a_folder_is_a_link)
{
    const Scratch scratch;
    scratch.write("top/mine.obj", "v 0 0 0\n");
    fs::create_directories(scratch / "far/away/real");
    fs::create_directory_symlink(scratch / "far/away/real", scratch / "top/link");
    Hairstyle style = load_hairstyle(scratch.write("top/bob.toml", "scalp.mesh = \"mine.obj\"\n"));
    save_hairstyle(style, scratch / "top/link/bob.toml");
    EXPECT_TRUE(fs::exists(resolve_path(style, "scalp.mesh", style.host.scalp_mesh, "/nowhere")))
        << style.host.scalp_mesh;
    const Hairstyle real = load_hairstyle(scratch / "far/away/real/bob.toml");
    EXPECT_TRUE(fs::exists(resolve_path(real, "scalp.mesh", real.host.scalp_mesh, "/nowhere"))) << real.host.scalp_mesh;
}

TEST(Hairstyle, an_absolute_path_is_kept)
{
    const Scratch scratch;
    const std::string mesh = scratch.write("mine.obj", "v 0 0 0\n").string();
    Hairstyle style = load_hairstyle(scratch.write("a/bob.toml", "scalp.mesh = '" + mesh + "'\n"));
    fs::create_directories(scratch / "b");
    save_hairstyle(style, scratch / "b/bob.toml");
    EXPECT_EQ(bytes_of(scratch / "b/bob.toml"), "scalp.mesh = '" + mesh + "'\n");
    EXPECT_EQ(resolve_path(style, "scalp.mesh", style.host.scalp_mesh, "/nowhere"), fs::path(mesh));
}

size_t files_in(const fs::path& folder)
{
    return size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator{}));
}

TEST(Hairstyle, a_save_that_fails_leaves_the_old_file_whole_and_the_style_as_it_was)
{
    const Scratch scratch;
    const fs::path file = scratch.write("shut/bob.toml", "[strand]\nlength = 0.2\n");
    Hairstyle style = load_hairstyle(file);
    assign(style, "strand.length=0.3");
    fs::permissions(file.parent_path(),
                    fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read | fs::perms::others_exec);
    fs::permissions(scratch.folder(), fs::perms::all);
    const uid_t user = geteuid();
    ASSERT_TRUE(user != 0 || seteuid(65534) == 0); // permissions do not stop root
    const std::string error = error_of([&] { save_hairstyle(style, file); });
    ASSERT_TRUE(user != 0 || seteuid(0) == 0);
    fs::permissions(file.parent_path(), fs::perms::owner_all);
    EXPECT_EQ(error, file.string() + ": cannot be written; is its folder there, and writable?");
    EXPECT_EQ(bytes_of(file), "[strand]\nlength = 0.2\n");
    EXPECT_EQ(files_in(scratch / "shut"), 1u);
    EXPECT_EQ(style.params.strand_length, 0.3f);
    EXPECT_EQ(style.text, "[strand]\nlength = 0.2\n");
}

TEST(Hairstyle, a_disk_that_is_full_is_told_and_loses_nothing)
{
    const Scratch scratch;
    const fs::path file = scratch.write("bob.toml", "[strand]\nlength = 0.2\n");
    Hairstyle style = load_hairstyle(file);
    style.host.maps.push_back({"strand.length", MAP_OFFSET, std::vector<float>(kMostInline, 0.1f), {}});
    // No file may grow beyond this: to a program that is as a disk without room.
    rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit tight = {1000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &tight);
    const std::string error = error_of([&] { save_hairstyle(style, file); });
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(error, file.string() + ": cannot be written: File too large; make room, or save elsewhere");
    EXPECT_EQ(bytes_of(file), "[strand]\nlength = 0.2\n");
    EXPECT_EQ(files_in(scratch.folder()), 1u);
    save_hairstyle(style, file);
    EXPECT_EQ(load_hairstyle(file).host.maps, style.host.maps);
}

TEST(Hairstyle, a_save_leaves_nothing_beside_the_file)
{
    const Scratch scratch;
    Hairstyle style;
    assign(style, "strand.length=0.3");
    save_hairstyle(style, scratch / "new.toml");
    EXPECT_EQ(files_in(scratch.folder()), 1u);
    fs::create_directories(scratch / "folder/inside");
    EXPECT_NE(error_of([&] { save_hairstyle(style, scratch / "folder"); }), "no error");
    EXPECT_EQ(files_in(scratch.folder()), 2u);
    EXPECT_NE(error_of([&] { save_hairstyle(style, scratch / "no/such/new.toml"); }), "no error");
}

TEST(Hairstyle, through_a_link_the_file_it_names_is_replaced_and_the_link_stays)
{
    const Scratch scratch;
    scratch.write("real/bob.toml", "[strand]\nlength = 0.2\n");
    fs::create_symlink("real/bob.toml", scratch / "link.toml");
    Hairstyle style = load_hairstyle(scratch / "link.toml");
    assign(style, "strand.length=0.3");
    save_hairstyle(style, scratch / "link.toml");
    EXPECT_TRUE(fs::is_symlink(scratch / "link.toml"));
    EXPECT_EQ(bytes_of(scratch / "real/bob.toml"), "[strand]\nlength = 0.3\n");
    EXPECT_EQ(files_in(scratch / "real"), 1u);
}

TEST(Hairstyle, a_save_keeps_who_may_read_the_file)
{
    const Scratch scratch;
    const fs::path file = scratch.write("bob.toml", "[strand]\nlength = 0.2\n");
    for (const fs::perms bits : {fs::perms(0600), fs::perms(0664), fs::perms(0755)})
    {
        fs::permissions(file, bits);
        Hairstyle style = load_hairstyle(file);
        assign(style, fmt::format("strand.length=0.{}", int(bits)));
        save_hairstyle(style, file);
        EXPECT_EQ(fs::status(file).permissions(), bits);
    }
}

TEST(Hairstyle, what_is_written_to_a_pipe_goes_through_it)
{
    const Scratch scratch;
    const std::string pipe = (scratch / "pipe").string();
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const int end = open(pipe.c_str(), O_RDWR | O_NONBLOCK);
    ASSERT_GE(end, 0);
    write_file(pipe, "words");
    char read_back[16] = {};
    EXPECT_EQ(read(end, read_back, sizeof read_back), 5);
    close(end);
    EXPECT_STREQ(read_back, "words");
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(Hairstyle, a_style_remembers_where_each_value_stands)
{
    const Hairstyle style = parse_hairstyle("head.scale = 2\n[scalp]\n  mesh = 'a.obj'\n", "bob.toml");
    EXPECT_EQ(style.places.at("scalp.mesh"), "bob.toml:3:10");
    EXPECT_EQ(style.places.at("head.scale"), "bob.toml:1:14");
    EXPECT_EQ(style.name(), "bob");
    EXPECT_EQ(Hairstyle{}.name(), "untitled");
}

TEST(Hairstyle, a_path_is_looked_for_beside_the_style_and_then_among_what_is_shipped)
{
    const Scratch scratch;
    scratch.write("data/a.obj", "");
    scratch.write("data/b.obj", "");
    scratch.write("style/a.obj", "");
    const Hairstyle style = parse_hairstyle("[scalp]\nmesh = 'c.obj'\n", scratch / "style/bob.toml");
    EXPECT_EQ(resolve_path(style, "scalp.mesh", "a.obj", scratch / "data"), scratch / "style/a.obj");
    EXPECT_EQ(resolve_path(style, "scalp.mesh", "b.obj", scratch / "data"), scratch / "data/b.obj");
    EXPECT_EQ(error_of([&] { resolve_path(style, "scalp.mesh", "c.obj", scratch / "data"); }),
              (scratch / "style/bob.toml").string() + ":2:8: scalp.mesh: no file 'c.obj', neither as " +
                  (scratch / "style/c.obj").string() + " nor as " + (scratch / "data/c.obj").string());
}

TEST(Hairstyle, every_shipped_one_loads_and_saves_to_the_same_bytes)
{
    int styles = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(COIF_SOURCE_FOLDER) / "hairstyles"))
        if (entry.path().extension() == ".toml")
        {
            const Hairstyle style = load_hairstyle(entry.path());
            EXPECT_EQ(hairstyle_text(style, style.file), bytes_of(entry.path())) << entry.path();
            ++styles;
        }
    EXPECT_GT(styles, 0);
}

} // namespace
} // namespace coif
