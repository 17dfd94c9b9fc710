// Job lists: what a line means, whose it is, and what its result hangs on.
#include "app/batch/jobs.h"
#include "app/batch/results.h"
#include "app/csv.h"
#include "app/options.h"
#include "tests/host/scratch.h"

#include <cstdio>
#include <memory>
#include <set>

namespace coif
{
namespace
{

using test::error_of;
using test::Scratch;
using Words = std::vector<std::string>;

const CheckLine anything = [](const Words&) {};

// What a shell makes of a line.
Words shell_words(const std::string& line)
{
    const std::string command = "set -f; printf '%s\\0' " + line;
    FILE* shell = popen(("sh -c '" +
                         [&]
                         {
                             std::string inner;
                             for (const char c : command)
                                 inner += c == '\'' ? std::string("'\\''") : std::string(1, c);
                             return inner;
                         }() +
                         "'")
                            .c_str(),
                        "r");
    Words words;
    std::string word;
    for (int c; (c = fgetc(shell)) != EOF;)
        if (c != 0)
            word += char(c);
        else
        {
            words.push_back(word);
            word.clear();
        }
    pclose(shell);
    return words;
}

TEST(Batch, a_line_means_what_it_means_to_a_shell)
{
    for (const char* line : {"shot bob -o a.png", "  shot\tbob   -o a.png  ", "shot 'a b.toml' -o \"c d.png\"",
                             "a\\ b c\\'d \\\"", "--set look.root_color=#a01010", "a 'it'\\''s' \"x\\\"y\\\\z\\w\"",
                             "'' \"\" a''b", "a # the rest", "a#b '#c'", "'$HOME' '*' 'a;b' \"it's\"", "x '~' a~b"})
        EXPECT_EQ(words_of(line), shell_words(line)) << line;
    EXPECT_EQ(words_of("  # a comment"), Words());
    EXPECT_EQ(words_of(""), Words());
    for (const char* line : {"a $HOME", "a *.toml", "a; b", "a | b", "a > b", "a `b`", "a \"$b\"", "a ~/b", "a 'b",
                             "a \"b", "a b\\", "a {b,c}", "a & b", "a (b)", "a [b]", "a !b", "a\x01"})
        EXPECT_NE(error_of([&] { words_of(line); }), "no error") << line;
    EXPECT_EQ(error_of([] { words_of("shot $x"); }).substr(0, 3), "6: ") << "the column";
}

TEST(Batch, quoted_words_are_read_back)
{
    for (const Words& words :
         {Words{"shot", "a b.toml", "", "it's", "$x", "#1", "~", "a\"b\\", "ä", "*?[]{}!", "x=y,z"},
          Words{"'", "''", " "}})
    {
        EXPECT_EQ(words_of(quoted(words)), words) << quoted(words);
        EXPECT_EQ(shell_words(quoted(words)), words) << quoted(words);
    }
}

TEST(Batch, tasks_are_counted_without_comments)
{
    const auto tasks =
        parse_list("# a sheet\n\nshot bob -o a.png\r\n  # and\nlab --gamma 3\nreport bob --json\n", "jobs", anything);
    ASSERT_EQ(tasks.size(), 3u);
    EXPECT_EQ(tasks[0].number, 1u);
    EXPECT_EQ(tasks[0].line, 3u);
    EXPECT_EQ(tasks[0].words, (Words{"shot", "bob"}));
    EXPECT_EQ(tasks[0].name, "a.png");
    EXPECT_EQ(tasks[0].text(), "shot bob -o a.png");
    EXPECT_EQ(tasks[1].number, 2u);
    EXPECT_EQ(tasks[1].line, 5u);
    EXPECT_TRUE(tasks[1].prints);
    EXPECT_EQ(tasks[1].name, "out.csv");
    EXPECT_EQ(tasks[2].name, "out.json");
    EXPECT_EQ(parse_list("shot bob --output=b.png", "jobs", anything)[0].name, "b.png");
    EXPECT_EQ(parse_list("shot -ob.png bob", "jobs", anything)[0].words, (Words{"shot", "bob"}));
}

TEST(Batch, every_bad_line_is_told_with_its_place)
{
    const struct
    {
        const char *line, *says;
    } bad[] = {{"edit bob", "'edit' makes no file"},
               {"run jobs.txt --out x", "'run' makes no file"},
               {"save bob -o x.toml", "'save' makes no file"},
               {"bench", "'bench' makes no file"},
               {"shot bob", "add -o NAME.png"},
               {"measure --only A1", "add -o NAME.csv"},
               {"measure -o folder.d", "writes its rows alone into a .csv"},
               {"shot bob -o ../../x.png", "only into the folder of the batch"},
               {"shot bob -o /tmp/x.png", "only into the folder of the batch"},
               {"shot bob -o a/b.png", "only into the folder of the batch"},
               {"shot bob -o ..", "only into the folder of the batch"},
               {"shot bob -o ''", "only into the folder of the batch"},
               {"shot bob -o -x.png", "only into the folder of the batch"},
               {"shot bob -o x", "the ending of what it is"},
               {"shot bob -o x.log", "the ending of what it is"},
               {"shot bob -o x_%04d.png", "one file"},
               {"shot bob -o a.png -o b.png", "stands twice"},
               {"shot bob --frames 0:9 -o a.png", "many pictures"},
               {"shot bob --turntable=9 -o a.png", "many pictures"},
               {"advise bob --apply -o a.txt", "--apply"},
               {"shot 'bob -o a.png", "has no end"}};
    std::string text = "shot bob -o a.png\n";
    for (const auto& one : bad)
        text += one.line + std::string("\n");
    std::string error = "no error";
    try
    {
        parse_list(text, "jobs.txt", anything);
    }
    catch (const BadList& e)
    {
        error = e.what();
    }
    size_t line = 2, at = 0;
    for (const auto& one : bad)
    {
        if (line - 2 == 20) // as many as are told at once
            break;
        at = error.find(fmt::format("jobs.txt:{}:", line), at);
        ASSERT_NE(at, error.npos) << one.line << "\n" << error;
        EXPECT_NE(error.find(one.says, at), error.npos) << one.line;
        EXPECT_NE(error_of([&] { parse_list(one.line, "jobs", anything); }).find(one.says), error.npos) << one.line;
        ++line;
    }
    EXPECT_EQ(error.find("jobs.txt:1:"), error.npos);
    EXPECT_NE(error_of([] { parse_list("# none\n", "jobs", anything); }).find("no task"), std::string::npos);
    EXPECT_NE(error_of([] { parse_list("shot bob -o a.png", "jobs", [](const Words&) { throw Error("not so"); }); })
                  .find("jobs:1: not so"),
              std::string::npos);
}

TEST(Batch, shards_part_a_list)
{
    std::string text;
    for (int i = 0; i < 100; ++i)
        text += "lab --gamma " + std::to_string(i) + "\n";
    const auto tasks = parse_list(text, "jobs", anything);
    for (const size_t count : {1, 2, 3, 7, 100, 150})
    {
        std::set<size_t> seen;
        for (size_t i = 0; i < count; ++i)
        {
            const Shard shard = parse_shard(fmt::format("{}/{}", i, count));
            size_t mine = 0;
            for (const Task& task : tasks)
                if (shard.holds(task))
                {
                    EXPECT_TRUE(seen.insert(task.number).second);
                    ++mine;
                }
            EXPECT_LE(mine, 100 / count + 1);
            EXPECT_GE(mine, 100 / count);
        }
        EXPECT_EQ(seen.size(), 100u) << count;
    }
    for (const char* bad :
         {"", "1", "1/", "/2", "2/2", "-1/2", "0/0", "1/2x", "x/2", "0x1/3", "1/99999999999999999999"})
        EXPECT_NE(error_of([&] { parse_shard(bad); }), "no error") << bad;
}

// The key of the only task of a list.
std::string key(const std::string& line) { return key_of(parse_list(line, "jobs", anything)[0]); }

TEST(Batch, a_result_hangs_on_the_line_and_on_every_file_behind_it)
{
    const Scratch scratch;
    const auto in = [&](const char* name) { return (scratch / name).string(); };
    scratch.write("map.toml", "[[thing]]\nfile = \"inner.bin\"\n");
    scratch.write("inner.bin", "1");
    scratch.write("head.gltf", "{\"buffers\": [{\"uri\": \"head.bin\"}]}");
    scratch.write("head.bin", "1");
    scratch.write("extra.obj", "1");
    scratch.write("move.toml", "1");
    scratch.write("other.bin", "1");
    scratch.write("bob.toml", "[head]\nmesh = \"head.gltf\"\n[region]\nmap = \"map.toml\"\n");
    const std::string line =
        "shot " + in("bob.toml") + " --motion=" + in("move.toml") + " --set head.x=extra.obj -o a.png";
    const std::string before = key(line);
    EXPECT_EQ(before.size(), 16u);
    EXPECT_EQ(key(line), before);
    EXPECT_EQ(key("  " + line + "   # a comment"), before) << "the words count";
    EXPECT_NE(key(line + " --time 1"), before);
    EXPECT_NE(key("shot " + in("bob.toml") + " -o a.png"), key("shot " + in("bob.toml") + " -o b.png"));
    EXPECT_NE(key("lab --gamma 12"), key("lab --gamma 1 2"));
    for (const char* name : {"bob.toml", "map.toml", "inner.bin", "head.gltf", "head.bin", "extra.obj", "move.toml"})
    {
        const std::string old = test::bytes_of(scratch / name);
        scratch.write(name, old + "\n");
        EXPECT_NE(key(line), before) << name;
        scratch.write(name, old);
        EXPECT_EQ(key(line), before) << name;
    }
    scratch.write("other.bin", "2");
    EXPECT_EQ(key(line), before) << "nobody names it";
    fs::last_write_time(scratch / "bob.toml", fs::file_time_type::clock::now() - std::chrono::hours(1000));
    EXPECT_EQ(key(line), before) << "what a file says counts, not its date";
    scratch.write("bob.toml", "[head\nbroken"); // is the task's to tell
    EXPECT_NE(key(line), before);
}

TEST(Batch, a_result_is_known_by_its_name)
{
    const Scratch scratch;
    const Task task = parse_list("lab", "jobs", anything)[0];
    const std::string stem = stem_of(task, key_of(task));
    EXPECT_TRUE(results_in(scratch.folder()).empty());
    keep_result(scratch.write("new/made.csv", "t,x\n"), scratch.folder(), stem, ".csv");
    scratch.write(stem + ".log", "words");
    fs::create_directories(unfinished_folder(scratch.folder(), stem));
    auto results = results_in(scratch.folder());
    ASSERT_EQ(results.size(), 1u);
    ASSERT_EQ(results[stem].size(), 1u);
    const Found found = results[stem][0];
    EXPECT_EQ(found.file.filename().string(), stem + "-" + digest_of_file(found.file) + ".csv");
    EXPECT_TRUE(is_whole(found));
    std::ofstream(found.file) << "t,y\n";
    EXPECT_FALSE(is_whole(found)) << "edited";
    std::ofstream(found.file) << "t,x\n";
    EXPECT_TRUE(is_whole(found));
    std::ofstream(found.file) << "t,x";
    EXPECT_FALSE(is_whole(found)) << "cut off";
    EXPECT_NE(error_of([&] { digest_of_file(scratch / "nothing"); }).find("cannot be read"), std::string::npos);
    // A block's length and more, in which a bit falls over.
    std::string large(200000, 'a');
    const std::string whole = digest_of_file(scratch.write("large", large));
    large[131072] = 'b';
    EXPECT_NE(digest_of_file(scratch.write("large", large)), whole);
    EXPECT_NE(digest_of_file(scratch.write("large", std::string(200000, 'a') + std::string(1, '\0'))), whole);
}

TEST(Batch, only_what_was_long_left_unfinished_is_removed)
{
    const Scratch scratch;
    const auto now = fs::file_time_type::clock::now();
    const auto make = [&](const std::string& name, int hours)
    {
        fs::create_directories(scratch / name);
        fs::last_write_time(scratch / name, now - std::chrono::hours(hours));
    };
    make("000001-0123456789abcdef.elsewhere.12.tmp", 30);
    make("000002-0123456789abcdef.elsewhere.12.tmp", 20);
    make("000003-0123456789abcdef.elsewhere.12.tmp", -30); // of a clock that is ahead
    make("mine.tmp", 30);
    make("000004-0123456789abcdef-0123456789abcdef.csv", 30);
    const Task task = parse_list("lab", "jobs", anything)[0];
    const fs::path own = unfinished_folder(scratch.folder(), stem_of(task, key_of(task))); // of a process that lives
    make(own.filename().string(), 30);
    EXPECT_EQ(remove_unfinished(scratch.folder()), 1);
    EXPECT_FALSE(fs::exists(scratch / "000001-0123456789abcdef.elsewhere.12.tmp"));
    EXPECT_EQ(std::distance(fs::directory_iterator(scratch.folder()), fs::directory_iterator()), 5);
}

TEST(Batch, tables_are_joined_under_one_head)
{
    EXPECT_EQ(joined_csv({{"a", "t,x\n1,2\n"}, {"b", "t,x\n3,\"4\n5\""}, {"c", "t,x"}}), "t,x\n1,2\n3,\"4\n5\"\n");
    EXPECT_NE(error_of(
                  [] {
                      joined_csv({{"a", "t,x\n"}, {"b", "t,y\n"}});
                  })
                  .find("a and b are tables of different"),
              std::string::npos);
    const auto records = csv_records("a,\"b,\"\"c\",\n\"d\ne\",,f\r\n");
    ASSERT_EQ(records.size(), 2u);
    EXPECT_EQ(records[0], (Words{"a", "b,\"c", ""}));
    EXPECT_EQ(records[1], (Words{"d\ne", "", "f"}));
}

TEST(Batch, lists_are_made_for_what_is_asked)
{
    JobsOptions wanted;
    wanted.styles = {"bob", "long"};
    wanted.passed = {"--size", "64x64"};
    EXPECT_EQ(sheet_jobs(wanted), (Words{"shot bob --size 64x64 -o bob.png", "shot long --size 64x64 -o long.png"}));
    wanted.random = 2;
    EXPECT_EQ(sheet_jobs(wanted)[3], "shot long --random 4 --size 64x64 -o long-4.png");
    wanted.views = 3;
    EXPECT_EQ(turntable_jobs(wanted)[4], "shot long --turntable 3 --view 1 --size 64x64 -o long_0001.png");
    wanted.views = 0;
    EXPECT_NE(error_of([&] { turntable_jobs(wanted); }), "no error");
    wanted.passed = {};
    wanted.vary = {"forces.drag=1,2,3", "forces.gravity=0.5,1"};
    const Words sweep = sweep_jobs(wanted);
    ASSERT_EQ(sweep.size(), 12u);
    EXPECT_EQ(sweep[1], "report bob --set forces.drag=1 --set forces.gravity=1 --row --untimed -o row.csv");
    wanted.vary = {"forces.gravity=1,1000"};
    EXPECT_NE(error_of([&] { sweep_jobs(wanted); }).find("forces.gravity is 1000"), std::string::npos);
    wanted.vary = {"forces.gravity"};
    EXPECT_NE(error_of([&] { sweep_jobs(wanted); }).find("expected group.key=VALUE"), std::string::npos);

    JobsOptions strained;
    strained.count = 45;
    strained.seed = 7;
    const Words stress = stress_jobs(strained);
    ASSERT_EQ(stress.size(), 3u);
    EXPECT_EQ(stress[2], "stress --only random --from 40 --cases 5 --seed 7 --untimed -o random-40.csv");
    strained.count = -1;
    strained.only = {"wind"};
    EXPECT_EQ(stress_jobs(strained), Words{"stress --only wind --seed 7 --untimed -o wind.csv"});
    strained.only = {"nothing"};
    EXPECT_NE(error_of([&] { stress_jobs(strained); }).find("there is no such case"), std::string::npos);

    JobsOptions measured;
    measured.only = {"A1"};
    EXPECT_EQ(sweep_jobs(measured), Words{"measure --only A1 --untimed -o A1.csv"});
    JobsOptions cached;
    cached.styles = {"bob"};
    cached.passed = {"--frames", "0:30"};
    EXPECT_EQ(cache_jobs(cached), Words{"export bob --frames 0:30 -o bob.usda"});
    cached.styles = {"nobody"};
    EXPECT_NE(error_of([&] { cache_jobs(cached); }).find("'nobody' is neither"), std::string::npos);
}

TEST(Batch, chance_hangs_on_its_number_alone)
{
    Options options;
    options.style = "bob";
    options.sets = {"strand.nodes=9"};
    const Hairstyle plain = load_style(options);
    options.random = 5;
    const Hairstyle once = load_style(options), again = load_style(options);
    options.random = 6;
    EXPECT_TRUE(same_style(once, again));
    EXPECT_FALSE(same_style(once, plain));
    EXPECT_FALSE(same_style(once, load_style(options)));
    EXPECT_EQ(once.params.strand_nodes, 9) << "--set has the last word";
}

} // namespace
} // namespace coif
