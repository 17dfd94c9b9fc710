#include "sim/error.h"
#include "sim/toml_edit.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <algorithm>
#include <map>
#include <random>
#include <sstream>

namespace
{

using coif::edit_toml;
using coif::edit_toml_array;
using coif::Error;
using coif::TomlEntry;

std::string set(const std::string& text, const std::string& group, const std::string& key, const std::string& value)
{
    return edit_toml(text, {{group, key, value}});
}

std::string removed(const std::string& text, const std::string& group, const std::string& key)
{
    return edit_toml(text, {{group, key, {}}});
}

const std::string kBob = "# Bob: short and blunt\n"
                         "name = \"bob\"   # shown in the panel\n"
                         "\n"
                         "# how long\n"
                         "[strand]\n"
                         "  length = 0.20   # metres\n"
                         "\tnodes=16# a tab\n"
                         "\n"
                         "# the solver\n"
                         "[solver.grid]   # a group in a group\n"
                         "size = [ 32,    # x\n"
                         "         32 ]   # y\n"
                         "\n"
                         "# the end\n";

TEST(TomlEdit, WithoutEditsKeepsEveryByte)
{
    for (const std::string text : {"", "\n", "# only a comment", "a = 1\r\n",
                                   "\xEF\xBB\xBF"
                                   "a=1"})
        EXPECT_EQ(edit_toml(text, {}), text);
    EXPECT_EQ(edit_toml(kBob, {}), kBob);
}

TEST(TomlEdit, ReplacesOnlyTheValue)
{
    EXPECT_EQ(set("[a]\n  b  =  1   # why\nc = 2\n", "a", "b", "3.5"), "[a]\n  b  =  3.5   # why\nc = 2\n");
    EXPECT_EQ(set("b=1# why", "", "b", "true"), "b=true# why");
    EXPECT_EQ(set("b = \"x # y\" # z\n", "", "b", "'q'"), "b = 'q' # z\n");
    EXPECT_EQ(set("b = 1", "", "b", " 2 # not this"), "b = 2");
}

TEST(TomlEdit, ReplacesValuesOfManyLines)
{
    EXPECT_EQ(set(kBob, "solver.grid", "size", "[8, 8]").find("size = [8, 8]   # y\n\n# the end\n"), kBob.find("size"));
    EXPECT_EQ(set("a = \"\"\"x\n  y\"\"\"\"\" # c\nb = 1\n", "", "a", "\"z\""), "a = \"z\" # c\nb = 1\n");
    EXPECT_EQ(set("a = '''\r\ny''' # c\r\nb = 1\r\n", "", "b", "2"), "a = '''\r\ny''' # c\r\nb = 2\r\n");
    EXPECT_EQ(set("a = [\n 1, # one\n]\nb = 1\n", "", "b", "2"), "a = [\n 1, # one\n]\nb = 2\n");
}

TEST(TomlEdit, WritesTheFilesLineEndingsInsideAValueToo)
{
    EXPECT_EQ(set("a = 1\r\nb = 1 # c\r\n", "", "b", "[1,\n2]"), "a = 1\r\nb = [1,\r\n2] # c\r\n");
    EXPECT_EQ(set("a = {} # c\r\n", "a", "b", "[1,\n2]"), "a = { b = [1,\r\n2] } # c\r\n");
    EXPECT_EQ(set("a = 1 # c\n", "", "a", "[1,\r\n2]"), "a = [1,\r\n2] # c\n");
}

TEST(TomlEdit, CountsCodePointsTabsAndTheByteOrderMark)
{
    EXPECT_EQ(set("\"k\xC3\xA4mm\".\"\xF0\x9F\x98\x80\" = 'e\xCC\x81' # \xE2\x82\xAC\nb = 1\n", "k\xC3\xA4mm",
                  "\xF0\x9F\x98\x80", "2"),
              "\"k\xC3\xA4mm\".\"\xF0\x9F\x98\x80\" = 2 # \xE2\x82\xAC\nb = 1\n");
    EXPECT_EQ(set("a = { n = '\xE2\x82\xAC\xE2\x82\xAC', b = 1 } # \xC3\xA4\n", "a", "b", "22"),
              "a = { n = '\xE2\x82\xAC\xE2\x82\xAC', b = 22 } # \xC3\xA4\n");
    EXPECT_EQ(set("\t\ta\t=\t1\t# t\n", "", "a", "2"), "\t\ta\t=\t2\t# t\n");
    EXPECT_EQ(set("\xEF\xBB\xBF"
                  "a = 1 # c\n",
                  "", "a", "2"),
              "\xEF\xBB\xBF"
              "a = 2 # c\n");
    EXPECT_EQ(removed("\xEF\xBB\xBF"
                      "a = 1 # c\nb = 2\n",
                      "", "a"),
              "\xEF\xBB\xBF"
              "b = 2\n");
    EXPECT_EQ(set("\xEF\xBB\xBF", "", "a", "1"), "\xEF\xBB\xBF"
                                                 "a = 1\n");
    EXPECT_EQ(set("\xEF\xBB\xBF"
                  "[g]\n",
                  "", "a", "1"),
              "\xEF\xBB\xBF"
              "a = 1\n\n[g]\n");
}

TEST(TomlEdit, LeavesAValueThatSaysTheSame)
{
    EXPECT_EQ(set(kBob, "strand", "length", "0.2"), kBob);
    EXPECT_EQ(set(kBob, "solver.grid", "size", "[32.0, 32]"), kBob);
    EXPECT_EQ(set("a = 0x10 # hex\nb = nan\n", "", "a", "16"), "a = 0x10 # hex\nb = nan\n");
    EXPECT_EQ(set("b = nan\n", "", "b", "nan"), "b = nan\n");
    EXPECT_EQ(set("a = { x = 1,y = 2 }", "", "a", "{ y = 2, x = 1 }"), "a = { x = 1,y = 2 }");
    EXPECT_EQ(set("a = '1'", "", "a", "1"), "a = 1");
}

TEST(TomlEdit, AddsAKeyAfterTheLastOfItsGroupAndIndentsItAlike)
{
    EXPECT_EQ(set("[a]\n  x = 1 # c\n\n# of b\n[b]\ny = 1\n", "a", "z", "2"),
              "[a]\n  x = 1 # c\n  z = 2\n\n# of b\n[b]\ny = 1\n");
    EXPECT_EQ(set("[a]\nx = [\n 1 ]  # c\n[b]\n", "a", "z", "2"), "[a]\nx = [\n 1 ]  # c\nz = 2\n[b]\n");
    EXPECT_EQ(set("[a]\nx = 1", "a", "z", "2"), "[a]\nx = 1\nz = 2\n");
    EXPECT_EQ(set("[a]\nx = 1\n[a.sub]\ny = 1\n", "a", "z", "2"), "[a]\nx = 1\nz = 2\n[a.sub]\ny = 1\n");
    EXPECT_EQ(set("[a]\nx.y = 1\n", "a", "z", "2"), "[a]\nx.y = 1\nz = 2\n");
    EXPECT_EQ(set("[a]\nx = 1\r\ny = 2\r\n", "a", "z", "2"), "[a]\nx = 1\r\ny = 2\r\nz = 2\r\n");
}

TEST(TomlEdit, AddsAKeyUnderAnEmptyHeader)
{
    EXPECT_EQ(set("[a] # c\n\n[b]\n", "a", "z", "2"), "[a] # c\nz = 2\n\n[b]\n");
    EXPECT_EQ(set("[b]\nx = 1\n [ \"a\" ]", "a", "z", "2"), "[b]\nx = 1\n [ \"a\" ]\n z = 2\n");
    EXPECT_EQ(set("[a]\n[a.b]\nx = 1\n", "a", "z", "2"), "[a]\nz = 2\n[a.b]\nx = 1\n");
}

TEST(TomlEdit, AddsAMissingGroupAtTheEnd)
{
    EXPECT_EQ(edit_toml(kBob, {{"wind", "speed", "3"}, {"wind", "gust", "1"}}),
              kBob + "\n[wind]\nspeed = 3\ngust = 1\n");
    EXPECT_EQ(set("", "a", "b", "1"), "[a]\nb = 1\n");
    EXPECT_EQ(set("x = 1", "a", "b", "1"), "x = 1\n\n[a]\nb = 1\n");
    EXPECT_EQ(set("x = 1\r\ny = 2", "a", "b", "1"), "x = 1\r\ny = 2\r\n\r\n[a]\r\nb = 1\r\n");
    EXPECT_EQ(set("x = 1\n\n", "a.b", "c d", "1"), "x = 1\n\n[a.b]\n\"c d\" = 1\n");
}

TEST(TomlEdit, GivesAnImplicitGroupItsHeader)
{
    EXPECT_EQ(set("[a.b.c]\nx = 1 # c\n", "a", "y", "2"), "[a.b.c]\nx = 1 # c\n\n[a]\ny = 2\n");
    EXPECT_EQ(set("[a.b.c]\nx = 1 # c\n[a.b]\nz = 1\n", "a", "y", "2"),
              "[a.b.c]\nx = 1 # c\n[a.b]\nz = 1\n\n[a]\ny = 2\n");
    EXPECT_EQ(set("[a.b]\nx = 1 # c\n[a]\n[d]\n", "a", "y", "2"), "[a.b]\nx = 1 # c\n[a]\ny = 2\n[d]\n");
    EXPECT_EQ(set("[[a.b]] # c\n", "a", "y", "2"), "[[a.b]] # c\n\n[a]\ny = 2\n");
}

TEST(TomlEdit, AddsToAnInlineTable)
{
    EXPECT_EQ(set("a = { b = 1 } # c\n", "a", "z", "2"), "a = { b = 1, z = 2 } # c\n");
    EXPECT_EQ(set("a = {b=[1,\n2]}# c\n", "a", "z", "2"), "a = {b=[1,\n2], z = 2}# c\n");
    EXPECT_EQ(set("a = {} # c\n", "a", "z", "2"), "a = { z = 2 } # c\n");
    EXPECT_EQ(set("a = {   } # c\n", "a", "z", "2"), "a = { z = 2 } # c\n");
    EXPECT_EQ(set("a = { b.c = 1 } # c\n", "a.b", "z", "2"), "a = { b.c = 1, b.z = 2 } # c\n");
    EXPECT_EQ(set("a = { b = {x=1} } # c\n", "a.b", "z", "2"), "a = { b = {x=1, z = 2} } # c\n");
    EXPECT_EQ(set("a = { b = 1 } # c\n", "a.new.er", "z", "2"), "a = { b = 1, new.er.z = 2 } # c\n");
}

TEST(TomlEdit, AddsADottedLineToADottedGroup)
{
    EXPECT_EQ(set("# c\n a . \"b\" = 1 # d\n\n[x]\n", "a", "z", "2"), "# c\n a . \"b\" = 1 # d\n a . z = 2\n\n[x]\n");
    EXPECT_EQ(set("[t]\na.b.c = 1 # d\nq = 1\n", "t.a", "z", "2"), "[t]\na.b.c = 1 # d\na.z = 2\nq = 1\n");
    EXPECT_EQ(set("[t]\na.b.c = 1 # d\nq = 1\n", "t.a.b", "z", "2"), "[t]\na.b.c = 1 # d\na.b.z = 2\nq = 1\n");
    EXPECT_EQ(set("a.b = 1 # d\n", "a.c", "z", "2"), "a.b = 1 # d\n\n[a.c]\nz = 2\n");
    EXPECT_EQ(set("[a.b.d] # d\nz = 1\n[a]\nb.c = 1\n", "a.b", "q", "2"),
              "[a.b.d] # d\nz = 1\n[a]\nb.c = 1\nb.q = 2\n");
}

TEST(TomlEdit, AddsATopLevelKeyBeforeTheFirstHeader)
{
    EXPECT_EQ(set("# licence\n# group a\n[a]\nb = 1", "", "z", "2"), "z = 2\n\n# licence\n# group a\n[a]\nb = 1");
    EXPECT_EQ(set("a = 1\n\n# b\n[b]\n", "", "z", "2"), "a = 1\nz = 2\n\n# b\n[b]\n");
    EXPECT_EQ(set("# licence\n\n# group a\n[a]\nb = 1\n", "", "z", "2"),
              "# licence\n\nz = 2\n\n# group a\n[a]\nb = 1\n");
    EXPECT_EQ(set("# c\r\n[[a]]\r\n", "", "z", "2"), "z = 2\r\n\r\n# c\r\n[[a]]\r\n");
    EXPECT_EQ(set("# c", "", "z", "2"), "# c\nz = 2\n");
    EXPECT_EQ(set("", "", "z", "2"), "z = 2\n");
}

TEST(TomlEdit, RemovesTheKeysLineAndKeepsTheCommentAboveIt)
{
    EXPECT_EQ(removed("[a]\n# about x\nx = [1,\n 2] # c\ny = 1\n", "a", "x"), "[a]\n# about x\ny = 1\n");
    EXPECT_EQ(removed("[a]\r\nx = 1\r\ny = 1", "a", "y"), "[a]\r\nx = 1\r\n");
    EXPECT_EQ(removed("a.b = 1 # c\na.c = 2\n", "a", "b"), "a.c = 2\n");
    EXPECT_EQ(removed("[a] # c\nx = 1\n", "a", "x"), "[a] # c\n");
    EXPECT_EQ(removed(kBob, "strand", "absent"), kBob);
    EXPECT_EQ(removed(kBob, "no.group", "absent"), kBob);
}

TEST(TomlEdit, RemovesAKeyFromAnInlineTable)
{
    const std::string text = "a = { x = 1, y.p = 2 , y.q = 3,z=4 } # c\n";
    EXPECT_EQ(removed(text, "a", "x"), "a = { y.p = 2 , y.q = 3,z=4 } # c\n");
    EXPECT_EQ(removed(text, "a", "z"), "a = { x = 1, y.p = 2 , y.q = 3 } # c\n");
    EXPECT_EQ(removed(text, "a.y", "p"), "a = { x = 1 , y.q = 3,z=4 } # c\n");
    EXPECT_EQ(removed(text, "a", "y"), "a = { x = 1,z=4 } # c\n");
    EXPECT_EQ(removed("a = { x = 1 } # c\n", "a", "x"), "a = {} # c\n");
    EXPECT_EQ(removed("a = { x.y = 1 , x.z = 1 } # c\n", "a", "x"), "a = {} # c\n");
    EXPECT_EQ(removed("b = [ 1, # c\n { x = 1 } ]\n", "", "b"), "");
}

TEST(TomlEdit, TurnsATableIntoAValueAndKeepsWhatStandsAround)
{
    EXPECT_EQ(set("[a]\nx = 1 # c\n[a.b]\n# gone\ny = 1\n[a.b.c]\nz = 1\n# stays\n[d]\n", "a", "b", "5"),
              "[a]\nx = 1 # c\nb = 5\n# stays\n[d]\n");
    EXPECT_EQ(set("[a]\nx = 1 # c\nb.p = 1\nb.q = 1\n", "a", "b", "5"), "[a]\nx = 1 # c\nb = 5\n");
    EXPECT_EQ(set("a = 1 # c\n[[b]]\nx = 1\n[[b]]\n", "", "b", "[]"), "a = 1 # c\nb = []\n");
}

TEST(TomlEdit, SetsTablesAsValues)
{
    EXPECT_EQ(set("[a]\nx = {y = 1} # c\n", "a", "x", "{ y = 2 }"), "[a]\nx = { y = 2 } # c\n");
    EXPECT_EQ(set("[a] # c\n", "a", "x", "{}"), "[a] # c\nx = {}\n");
}

TEST(TomlEdit, RefusesWhatIsNoToml)
{
    EXPECT_THROW(set("a = ", "", "a", "1"), Error);
    EXPECT_THROW(edit_toml("a = 1\na = 2\n", {}), Error);
    EXPECT_THROW(set("a = 1", "", "a", "1\nb = 2"), Error);
    EXPECT_THROW(set("a = 1", "", "a", ""), Error);
    EXPECT_THROW(set("a = 1", "", "a", "one"), Error);
    EXPECT_THROW(set("a = 1", "a", "b", "1"), Error);
    EXPECT_THROW(set("[[a]]", "a", "b", "1"), Error);
    EXPECT_THROW(edit_toml_array("", "a", {{{"x", "1"}, {"x", "2"}}}), Error);
    try
    {
        edit_toml("a = 1\nb = ?\n", {});
        FAIL();
    }
    catch (const Error& error)
    {
        EXPECT_EQ(std::string(error.what()).rfind("2:5: ", 0), 0u) << error.what();
    }
}

// ---- Arrays of tables ----

const std::string kTies =
    "[a]\nx = 1\n\n# the upper\n[[tie]]\nat = 0.50 # half\nname = 'u'\n\n# the lower\n[[tie]] # 2\nat = 0.8\n"
    "[tie.sub]\nq = 1\n\n# of b\n[b]\n";

TEST(TomlEditArray, LeavesEqualEntriesAlone)
{
    const std::vector<TomlEntry> same = {{{"at", "0.5"}, {"name", "\"u\""}}, {{"sub", "{ q = 1 }"}, {"at", "0.8"}}};
    EXPECT_EQ(edit_toml_array(kTies, "tie", same), kTies);
    EXPECT_EQ(edit_toml_array("tie = [ {a=1},# c\n {} ]", "tie", {{{"a", "1"}}, {}}), "tie = [ {a=1},# c\n {} ]");
    EXPECT_EQ(edit_toml_array("# c", "tie", {}), "# c");
    EXPECT_EQ(edit_toml_array("tie = []", "tie", {}), "tie = []");
}

TEST(TomlEditArray, PatchesAddsAndRemovesKeysOfAnEntry)
{
    EXPECT_EQ(
        edit_toml_array(kTies, "tie", {{{"at", "0.6"}, {"z", "1"}}, {{"at", "0.8"}, {"sub", "{ q = 2, r = 3 }"}}}),
        "[a]\nx = 1\n\n# the upper\n[[tie]]\nat = 0.6 # half\nz = 1\n\n# the lower\n[[tie]] # 2\nat = 0.8\n"
        "sub = { q = 2, r = 3 }\n\n# of b\n[b]\n");
    EXPECT_EQ(edit_toml_array("[[t]] # c\n[[t]]", "t", {{{"a", "1"}}, {{"b", "2"}}}),
              "[[t]] # c\na = 1\n[[t]]\nb = 2\n");
}

TEST(TomlEditArray, AppendsAfterTheLastEntryAndItsTables)
{
    std::vector<TomlEntry> entries = {{{"at", "0.5"}, {"name", "\"u\""}}, {{"at", "0.8"}, {"sub", "{ q = 1 }"}}};
    entries.push_back({{"at", "1"}, {"name", "'new'"}});
    std::string wanted = kTies;
    wanted.insert(wanted.find("\n# of b"), "\n[[tie]]\nat = 1\nname = 'new'\n");
    EXPECT_EQ(edit_toml_array(kTies, "tie", entries), wanted);
    entries.pop_back();
    EXPECT_EQ(edit_toml_array(wanted, "tie", entries), kTies);
    EXPECT_EQ(edit_toml_array("x = 1\r\n", "a.t", {{{"p", "1"}}, {}}),
              "x = 1\r\n\r\n[[a.t]]\r\np = 1\r\n\r\n[[a.t]]\r\n");
    EXPECT_EQ(edit_toml_array("", "t", {{{"p", "1"}}}), "[[t]]\np = 1\n");
}

TEST(TomlEditArray, RemovesSurplusEntriesWithTheirTables)
{
    EXPECT_EQ(edit_toml_array(kTies, "tie", {{{"at", "0.5"}, {"name", "\"u\""}}}),
              "[a]\nx = 1\n\n# the upper\n[[tie]]\nat = 0.50 # half\nname = 'u'\n\n# the lower\n\n# of b\n[b]\n");
    EXPECT_EQ(edit_toml_array(kTies, "tie", {}), "[a]\nx = 1\n\n# the upper\n\n# the lower\n\n# of b\n[b]\n");
    EXPECT_EQ(edit_toml_array("[[t]]\nx=1\n[b] # b\n[t.sub]\ny=1\n[c]", "t", {}), "[b] # b\n[c]");
    EXPECT_EQ(edit_toml_array("[[t]]\nx.y=1\n[[t.in]]\n[[t.in]]\nz=1\n[c]", "t", {}), "[c]");
}

TEST(TomlEditArray, RewritesAnInlineArrayAsAWhole)
{
    EXPECT_EQ(edit_toml_array("t = [ {a=1}, {b=2} ] # c\n", "t", {{{"a", "3"}}, {}}), "t = [{ a = 3 }, {}] # c\n");
    EXPECT_EQ(edit_toml_array("t = [\n {a=1},\n] # c\n", "t", {{{"a", "1"}}, {{"b", "[1,\n2]"}}}),
              "t = [\n    { a = 1 },\n    { b = [1,\n2] },\n] # c\n");
    EXPECT_EQ(edit_toml_array("t = [\n {a=1} ] # c\n", "t", {}), "t = [] # c\n");
    EXPECT_EQ(edit_toml_array("g = { x = 1 } # c\n", "g.t", {{{"a", "1"}}}), "g = { x = 1, t = [{ a = 1 }] } # c\n");
}

// ---- Seeded random documents ----

using Values = std::map<std::pair<std::string, std::string>, std::string>;

struct Line
{
    std::string text, group, key; // key is empty for headers, comments and blank lines
};

struct Random
{
    std::mt19937 engine;
    size_t below(size_t n) { return engine() % n; }
    std::string of(const std::vector<std::string>& choices) { return choices[below(choices.size())]; }
    std::string space() { return of({"", " ", "  ", "\t", " "}); }
    std::string comment() { return of({"", "", " # c", "# = [x] \xC3\xA4\xE2\x82\xAC", "\t# \"q", "   "}); }
    std::string value()
    {
        return of({"0", "1", "-2.5", "1e-3", "true", "\"s # t\"", "'\xC3\xA4\xF0\x9F\x98\x80 = 1'", "[1, 2,3]", "[ ]",
                   "{}", "{ u = 1, v.w = [1] }", "\"\"\"m\n[x]\ny\"\"\"", "[\n  1, # one\n\n  2\n]", "2020-01-01"});
    }
};

const std::vector<std::string> kGroups = {"", "dots", "strand", "solver.grid", "\xC3\xB6 x"};
const std::vector<std::string> kKeys = {"a", "b", "c_d", "e-f", "g h", "\xC3\xA4", "1"};

std::string quoted(const std::string& name)
{
    const bool bare =
        std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; });
    return bare ? name : "\"" + name + "\"";
}

std::string with_endings(const std::string& text, bool crlf)
{
    std::string result;
    for (const char c : text)
        if (c != '\r')
            result += c == '\n' && crlf ? "\r\n" : std::string(1, c);
    return result;
}

std::vector<std::string> split_lines(const std::string& text)
{
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

std::vector<Line> random_lines(Random& random, bool crlf, Values& values)
{
    std::vector<Line> lines;
    const auto add = [&](const std::string& text, const std::string& group = "", const std::string& key = "") {
        lines.push_back({with_endings(text + "\n", crlf), group, key});
    };
    const auto fill = [&]
    {
        while (random.below(3) == 0)
            add(random.of({"", "# = 1", "  # [strand]", "\t", "# \xE2\x82\xAC"}));
    };
    for (const auto& group : kGroups)
    {
        if (!group.empty() && random.below(4) == 0)
            continue;
        fill();
        if (!group.empty() && group != "dots")
            add(random.space() + "[" + random.space() + (group == "solver.grid" ? "solver . grid" : quoted(group)) +
                "]" + random.comment());
        for (const auto& key : kKeys)
        {
            if (random.below(2))
                continue;
            fill();
            const std::string value = random.value(), dots = group == "dots" ? "dots" + random.space() + "." : "";
            add(random.space() + dots + quoted(key) + random.space() + "=" + random.space() + value + random.comment(),
                group, key);
            values[{group, key}] = value;
        }
    }
    fill();
    return lines;
}

const toml::node* look_up(const toml::table& root, const std::string& group, const std::string& key)
{
    const toml::table* table = &root;
    std::istringstream names(group);
    for (std::string name; table && std::getline(names, name, '.');)
        table = table->get_as<toml::table>(name);
    if (!table)
        return nullptr;
    return table->get(key);
}

size_t count_values(const toml::table& table, bool top)
{
    size_t count = 0;
    for (auto&& [key, node] : table)
        if (const auto* child = node.as_table(); child && !child->is_inline() && (top || key == "grid"))
            count += count_values(*child, key == "solver");
        else
            ++count;
    return count;
}

TEST(TomlEdit, KeepsEveryUntouchedLineOfRandomDocuments)
{
    for (unsigned seed = 0; seed < 3000; ++seed)
    {
        Random random{std::mt19937(seed)};
        const bool crlf = random.below(2);
        Values values;
        std::vector<Line> lines = random_lines(random, crlf, values);
        const std::string mark = random.below(4) ? "" : "\xEF\xBB\xBF";
        std::string text = mark;
        if (!lines.empty() && random.below(4) == 0)
            lines.back().text.resize(lines.back().text.size() - (crlf ? 2 : 1));
        for (const auto& line : lines)
            text += line.text;

        std::vector<coif::TomlEdit> edits;
        std::map<std::pair<std::string, std::string>, bool> touched;
        for (size_t n = 1 + random.below(6); n > 0; --n)
        {
            const std::string group = random.of(kGroups), key = random.of(kKeys);
            edits.push_back({group, key, {}});
            if (random.below(3))
                values[{group, key}] = *(edits.back().value = random.value());
            else
                values.erase({group, key});
            touched[{group, key}] = true;
        }
        const std::string result = edit_toml(text, edits);

        // Without their endings, for a last line without one may have gained it.
        std::string untouched;
        for (const auto& line : lines)
            if (line.key.empty() || !touched[{line.group, line.key}])
                untouched += with_endings(line.text, false);
        ASSERT_EQ(result.substr(0, mark.size()), mark);
        const auto left = split_lines(with_endings(result.substr(mark.size()), false));
        auto at = left.begin();
        for (const auto& line : split_lines(untouched))
        {
            at = std::find(at, left.end(), line);
            ASSERT_NE(at++, left.end()) << "seed " << seed << " lost " << line << "\n" << text << "\n" << result;
        }
        if (text.find('\n') != std::string::npos)
        {
            ASSERT_EQ(with_endings(result, crlf), result) << "seed " << seed;
        }

        const toml::table root = toml::parse(result);
        for (const auto& [place, value] : values)
        {
            const toml::table holder = toml::parse("v = " + value);
            const toml::node* node = look_up(root, place.first, place.second);
            ASSERT_TRUE(node) << "seed " << seed;
            ASSERT_EQ(toml::table({{"v", *node}}), holder) << "seed " << seed << "\n" << text << "\n" << result;
        }
        ASSERT_EQ(count_values(root, true), values.size()) << "seed " << seed << "\n" << result;
    }
}

TEST(TomlEditArray, KeepsEveryUntouchedLineOfRandomDocuments)
{
    for (unsigned seed = 0; seed < 1000; ++seed)
    {
        Random random{std::mt19937(seed)};
        const bool crlf = random.below(2);
        const auto entry = [&random]
        {
            TomlEntry made;
            for (const auto& key : kKeys)
                if (random.below(3) == 0)
                    made.emplace_back(key, random.value());
            return made;
        };
        std::string text = "a = 1 # first\n\n";
        std::vector<std::string> kept = {"a = 1 # first\n"};
        for (size_t i = 0, n = random.below(4); i < n; ++i)
        {
            kept.push_back(fmt::format("# entry {}\n", i));
            text += kept.back() + "[[" + random.space() + "tie ]]" + random.comment() + "\n";
            for (const auto& [key, value] : entry())
                text += random.space() + quoted(key) + random.space() + "=" + value + random.comment() + "\n";
            text += random.of({"", "\n", "[tie.sub]\nx = 1\n"});
        }
        kept.push_back("# last\n[z] # z\nq=1");
        text = with_endings(text + kept.back(), crlf);

        std::vector<TomlEntry> entries(random.below(5));
        std::generate(entries.begin(), entries.end(), entry);
        const std::string result = edit_toml_array(text, "tie", entries);

        size_t at = 0;
        for (const auto& lines : kept)
        {
            at = result.find(with_endings(lines, crlf), at);
            ASSERT_NE(at, std::string::npos) << "seed " << seed << "\n" << text << "\n" << result;
        }
        toml::table root = toml::parse(result), wanted = toml::parse("a = 1\nz = { q = 1 }");
        for (const auto& items : entries)
        {
            toml::table table;
            for (const auto& [key, value] : items)
                table.insert(key, *toml::parse("v = " + value).get("v"));
            if (!wanted.contains("tie"))
                wanted.insert("tie", toml::array{});
            wanted.get_as<toml::array>("tie")->push_back(table);
        }
        ASSERT_EQ(root, wanted) << "seed " << seed << "\n" << text << "\n" << result;
        ASSERT_EQ(edit_toml_array(result, "tie", entries), result);
    }
}

} // namespace
