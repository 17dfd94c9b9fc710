#include "app/batch/list.h"

#include "sim/hairstyle.h"

#include <algorithm>
#include <charconv>
#include <cstring>

namespace coif
{

namespace fs = std::filesystem;

static constexpr size_t kMostFaults = 20;     // told at once
static constexpr size_t kMostBytes = 1 << 28; // of a list
static constexpr size_t kMostShards = 1000000;

// Commands that make one file and nothing else. `printed` is the ending of what goes to standard output without -o;
// null: -o must be said.
static const struct Maker
{
    const char* command;
    const char* printed;
} kMakers[] = {{"shot", nullptr},  {"sheet", nullptr}, {"export", nullptr}, {"measure", nullptr}, {"stress", nullptr},
               {"report", ".txt"}, {"lab", ".csv"},    {"advise", ".txt"},  {"check", ".txt"}};

std::string Task::text() const { return quoted(words) + (prints ? "" : " -o " + quoted(name)); }

std::vector<std::string> words_of(const std::string& line)
{
    std::vector<std::string> words;
    std::string word;
    bool in_word = false;
    char quote = 0;
    for (size_t i = 0; i < line.size(); ++i)
    {
        const char c = line[i];
        if (static_cast<unsigned char>(c) < 0x20 && c != '\t')
            throw fail("{}: a control character, which no line can hold", i + 1);
        if (quote == '\'')
        {
            if (c == quote)
                quote = 0;
            else
                word += c;
        }
        else if (c == '\\')
        {
            if (++i == line.size())
                throw fail("{}: nothing follows the \\; a task is one line", i);
            // Within "..." it is itself before all but these.
            if (quote && !std::strchr("\\\"$`", line[i]))
                word += c;
            word += line[i];
            in_word = true;
        }
        else if (quote ? c == quote : c == '\'' || c == '"')
        {
            quote = quote ? char(0) : c;
            in_word = true;
        }
        else if (std::strchr(quote ? "$`" : "$`&|;<>()*?[]{}!", c))
            throw fail("{}: '{}' would mean something else to a shell; put it into '...'", i + 1, c);
        else if (!quote && (c == ' ' || c == '\t'))
        {
            if (in_word)
                words.push_back(word);
            word.clear();
            in_word = false;
        }
        else if (!quote && !in_word && c == '#')
            break;
        else if (!quote && !in_word && c == '~')
            throw fail("{}: a ~ is the shell's to replace; write the folder out, or put it into '...'", i + 1);
        else
        {
            word += c;
            in_word = true;
        }
    }
    if (quote)
        throw fail("{}: a quotation mark, {}, has no end; a task is one line", line.size(), quote);
    if (in_word)
        words.push_back(word);
    return words;
}

std::string quoted(const std::string& word)
{
    const bool plain =
        !word.empty() &&
        std::ranges::all_of(word, [](char c)
                            { return std::isalnum(static_cast<unsigned char>(c)) || std::strchr("_-./:,=+@%", c); });
    if (plain)
        return word;
    std::string out = "'";
    for (const char c : word)
        out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

std::string quoted(const std::vector<std::string>& words)
{
    std::string out;
    for (const std::string& word : words)
        out += (out.empty() ? "" : " ") + quoted(word);
    return out;
}

// Takes -o out of the words; false if there is none.
static bool take_output(std::vector<std::string>& words, std::string& output)
{
    bool found = false;
    for (size_t i = 1; i < words.size();)
    {
        const std::string word = words[i];
        size_t spent = 1;
        if ((word == "-o" || word == "--output") && i + 1 < words.size())
        {
            output = words[i + 1];
            spent = 2;
        }
        else if (word.starts_with("--output="))
            output = word.substr(9);
        else if (word.starts_with("-o") && word.size() > 2)
            output = word.substr(2);
        else
        {
            ++i;
            continue;
        }
        if (found)
            throw Error("-o stands twice; a task makes one file");
        found = true;
        words.erase(words.begin() + ptrdiff_t(i), words.begin() + ptrdiff_t(i + spent));
    }
    return found;
}

Task task_of(const std::vector<std::string>& words)
{
    Task task{0, 0, words, {}};
    std::vector<std::string> names;
    const Maker* maker = nullptr;
    for (const Maker& one : kMakers)
    {
        names.emplace_back(one.command);
        if (words[0] == one.command)
            maker = &one;
    }
    if (!maker)
        throw fail("'{}' makes no file that a batch could join; tasks are {}", words[0], fmt::join(names, ", "));
    const auto says = [&](const char* word) { return std::ranges::count(words, word) > 0; };
    const bool named = take_output(task.words, task.name);
    if (says("--apply"))
        throw Error("--apply writes a style, whose paths hang on where it lies; apply it without a batch");
    if (!named)
    {
        if (!maker->printed)
            throw fail("{} must say the name of its result: add -o NAME{}", words[0],
                       words[0] == std::string("measure") || words[0] == std::string("stress") ? ".csv" : ".png");
        task.prints = true;
        task.name = std::string("out") + (says("--json") ? ".json" : says("--csv") ? ".csv" : maker->printed);
        return task;
    }
    const fs::path name = task.name;
    if (name.filename() != name || task.name == "." || task.name == ".." || task.name.empty() || task.name[0] == '-' ||
        task.name[0] == '.')
        throw fail("-o {}: a task writes only into the folder of the batch; give the name of a file, without a folder",
                   task.name);
    const std::string ending = name.extension().string();
    if (ending.size() < 2 || ending == ".log" || ending == ".tmp" || ending == ".new")
        throw fail("-o {}: expected a name with the ending of what it is, as .png or .csv", task.name);
    if (task.name.find_first_of("%\n") != task.name.npos)
        throw fail("-o {}: a task makes one file; write a line for each picture instead of a number in the name",
                   task.name);
    const bool film = ending == ".mp4" || ending == ".webm" || ending == ".gif";
    const auto begins = [&](const char* option)
    {
        return std::ranges::any_of(words, [&](const std::string& w)
                                   { return w == option || w.starts_with(option + std::string("=")); });
    };
    if (words[0] == "shot" && !film && ((begins("--turntable") && !begins("--view")) || begins("--frames")))
        throw fail("-o {}: that are many pictures, and a task makes one file; say --time or --view in a line for each, "
                   "or ask for a film",
                   task.name);
    if ((words[0] == "measure" || words[0] == "stress") && ending != ".csv")
        throw fail("-o {}: {} writes its rows alone into a .csv, and anything else is a folder", task.name, words[0]);
    return task;
}

std::vector<Task> parse_list(const std::string& text, const std::string& name, const CheckLine& check)
{
    std::vector<Task> tasks;
    std::vector<std::string> faults;
    size_t line = 0, wrong = 0;
    for (size_t from = 0; from < text.size();)
    {
        const size_t end = std::min(text.find('\n', from), text.size());
        std::string one = text.substr(from, end - from);
        from = end + 1;
        ++line;
        if (one.ends_with('\r'))
            one.pop_back();
        try
        {
            std::vector<std::string> words;
            try
            {
                words = words_of(one);
            }
            catch (const Error& e) // begins with the column
            {
                throw fail("{}:{}:{}", name, line, e.what());
            }
            if (words.empty())
                continue;
            try
            {
                Task task = task_of(words);
                check(words);
                task.number = tasks.size() + 1;
                task.line = line;
                tasks.push_back(std::move(task));
            }
            catch (const Error& e)
            {
                throw fail("{}:{}: {}", name, line, e.what());
            }
        }
        catch (const Error& e)
        {
            if (++wrong <= kMostFaults)
                faults.emplace_back(e.what());
        }
    }
    if (wrong > kMostFaults)
        faults.push_back(fmt::format("and {} lines more", wrong - kMostFaults));
    if (wrong)
        throw BadList(fmt::format("{}\nnothing has been done", fmt::join(faults, "\n")));
    if (tasks.empty())
        throw BadList(name + ": holds no task; coif jobs writes some");
    return tasks;
}

std::vector<Task> read_list(const fs::path& file, const CheckLine& check)
{
    std::string text;
    try
    {
        text = read_file(file, kMostBytes);
    }
    catch (const Error& e)
    {
        throw BadList(e.what());
    }
    return parse_list(text, file.string(), check);
}

Shard parse_shard(const std::string& text)
{
    Shard shard;
    const size_t slash = text.find('/');
    const char *begin = text.data(), *end = begin + text.size();
    if (slash != text.npos)
    {
        const auto index = std::from_chars(begin, begin + slash, shard.index);
        const auto count = std::from_chars(begin + slash + 1, end, shard.count);
        if (index.ec == std::errc() && index.ptr == begin + slash && count.ec == std::errc() && count.ptr == end &&
            shard.count >= 1 && shard.count <= kMostShards && shard.index < shard.count)
            return shard;
    }
    throw fail("--shard {}: expected I/N, from 0/N to N-1/N", text);
}

} // namespace coif
