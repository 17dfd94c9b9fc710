#include "app/batch/merge.h"

#include "app/batch/results.h"
#include "app/csv.h"
#include "app/film.h"
#include "app/sheet.h"
#include "sim/hairstyle.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <unistd.h>

namespace coif
{

namespace fs = std::filesystem;

namespace
{
struct Part
{
    const Task* task;
    fs::path file;
};
} // namespace

static std::string who(const Task& task) { return fmt::format("task {} ({})", task.number, task.text()); }

// The whole results in the list's order; none of them if one is not as it should be, which is told.
static std::vector<Part> parts_of(const std::vector<Task>& tasks, const fs::path& folder)
{
    const auto results = results_in(folder);
    const std::string program = digest_of_program();
    std::vector<Part> parts;
    size_t missing = 0, wrong = 0;
    for (const Task& task : tasks)
    {
        const std::string stem = stem_of(task, key_of(task, program));
        const auto found = results.find(stem);
        std::vector<const Found*> whole;
        if (found != results.end())
            for (const Found& one : found->second)
                if (is_whole(one))
                    whole.push_back(&one);
                else
                {
                    ++wrong;
                    fmt::print(stderr, "changed {}: {}; coif run makes it again\n", task.number, one.file.string());
                }
        else
        {
            ++missing;
            fmt::print(stderr, "missing {}: {}\n", task.number, task.text());
        }
        if (whole.size() > 1)
        {
            ++wrong;
            fmt::print(stderr,
                       "ambiguous {}: {} and {} differ: this task does not make the same bytes everywhere; say "
                       "--device in it, or keep one of them\n",
                       task.number, whole[0]->file.string(), whole[1]->file.string());
        }
        if (whole.size() == 1)
            parts.push_back({&task, whole[0]->file});
    }
    if (missing || wrong)
    {
        fmt::print(stderr, "{} of {} tasks are missing, {} are not as they were made; nothing is joined\n", missing,
                   tasks.size(), wrong);
        parts.clear();
    }
    return parts;
}

static std::string ending_of(const std::vector<Part>& parts)
{
    for (const Part& part : parts)
        if (part.file.extension() != parts[0].file.extension())
            throw fail("{} makes {} and {} makes {}, which cannot be one; merge them into a folder: -o NAME/",
                       who(*parts[0].task), parts[0].file.extension().string(), who(*part.task),
                       part.file.extension().string());
    return parts[0].file.extension().string();
}

static Image picture_of(const Part& part, const Part& first, int& width, int& height)
{
    Image image = load_png(part.file);
    if (width == 0)
        width = image.width, height = image.height;
    if (image.width != width || image.height != height)
        throw fail("{} makes a picture of {} x {} and {} one of {} x {}; say the same --size in both", who(*first.task),
                   width, height, who(*part.task), image.width, image.height);
    return image;
}

static void join_sheet(const std::vector<Part>& parts, const MergeOptions& wanted)
{
    std::vector<std::string> names, calls;
    for (const Part& part : parts)
    {
        names.push_back(fs::path(part.task->name).stem().string());
        calls.push_back(part.task->words.size() > 1 ? part.task->words[1] : "");
    }
    const std::vector<std::string> labels = sheet_labels(names, calls);
    int width = 0, height = 0;
    picture_of(parts[0], parts[0], width, height);
    const SheetLayout at = lay_out(int(parts.size()), wanted.columns, width, height);
    Image page = empty_sheet(at);
    for (size_t i = 0; i < parts.size(); ++i)
    {
        const Image picture = picture_of(parts[i], parts[0], width, height);
        put_cell(page, at, int(i), &picture, labels[i]);
    }
    save_png(wanted.output, page);
}

static void join_film(const std::vector<Part>& parts, const MergeOptions& wanted)
{
    if (!has_ffmpeg())
        throw fail("-o {}: a film needs ffmpeg, which is not installed (on Debian: apt-get install ffmpeg); -o {}/ "
                   "keeps the pictures",
                   wanted.output, fs::path(wanted.output).stem().string());
    int width = 0, height = 0;
    picture_of(parts[0], parts[0], width, height);
    Film film(wanted.output, width, height, wanted.fps, false);
    for (const Part& part : parts)
        film.add(picture_of(part, parts[0], width, height));
    film.finish();
}

// How many rows say that they missed what they are held to.
static size_t missed_in(const std::string& table)
{
    const auto records = csv_records(table);
    size_t missed = 0;
    for (size_t column = 0; column < records[0].size(); ++column)
        for (const auto& fields : records)
            missed += column < fields.size() && ((records[0][column] == "verdict" && fields[column] == "MISSED") ||
                                                 (records[0][column] == "passed" && fields[column] == "false"));
    return missed;
}

static size_t join_tables(const std::vector<Part>& parts, const MergeOptions& wanted)
{
    std::vector<std::pair<std::string, std::string>> tables;
    for (const Part& part : parts)
        tables.emplace_back(who(*part.task), read_file(part.file));
    const std::string joined = joined_csv(tables);
    write_file(wanted.output, joined);
    return missed_in(joined);
}

static void join_objects(const std::vector<Part>& parts, const MergeOptions& wanted)
{
    std::string out;
    for (const Part& part : parts)
    {
        std::string text = read_file(part.file);
        text.erase(text.find_last_not_of("\r\n ") + 1);
        out += (out.empty() ? "[\n" : ",\n") + text;
    }
    write_file(wanted.output, out + "\n]\n");
}

static void join_texts(const std::vector<Part>& parts, const MergeOptions& wanted)
{
    std::string out;
    for (const Part& part : parts)
        out += read_file(part.file);
    write_file(wanted.output, out);
}

static void gather(const std::vector<Part>& parts, const fs::path& folder)
{
    std::set<std::string> names;
    for (const Part& part : parts)
        if (!names.insert(part.task->name).second)
            throw fail("{} has the name of one before it, and a folder holds a name once; say another -o",
                       who(*part.task));
    make_folder(folder);
    for (const Part& part : parts)
    {
        // Results may be larger than what fits into memory.
        const fs::path file = folder / part.task->name, beside = file.string() + fmt::format(".{}.new", getpid());
        std::error_code error, ignored;
        fs::copy_file(part.file, beside, fs::copy_options::overwrite_existing, error);
        if (!error)
            fs::rename(beside, file, error);
        if (error)
        {
            fs::remove(beside, ignored);
            throw fail("{}: cannot be written: {}", file.string(), error.message());
        }
    }
}

int merge_tasks(const std::vector<Task>& tasks, const MergeOptions& wanted)
{
    std::error_code error;
    if (!fs::is_directory(wanted.folder, error))
        throw fail("--out {}: there is no such folder; coif run makes it", wanted.folder.string());
    const bool into_folder = wanted.output.ends_with('/') || fs::is_directory(wanted.output, error);
    if (!into_folder)
        check_folder(wanted.output);
    if (const int removed = remove_unfinished(wanted.folder))
        fmt::print(stderr, "removed what {} killed tasks had left unfinished\n", removed);
    const std::vector<Part> parts = parts_of(tasks, wanted.folder);
    if (parts.empty())
        return 1;

    const std::string to = fs::path(wanted.output).extension().string();
    size_t missed = 0;
    if (into_folder)
        gather(parts, wanted.output);
    else if (const std::string from = ending_of(parts); from == ".png" && to == ".png")
        join_sheet(parts, wanted);
    else if (from == ".png" && !film_format(wanted.output).empty())
        join_film(parts, wanted);
    else if (from == ".csv" && to == ".csv")
        missed = join_tables(parts, wanted);
    else if (from == ".json" && to == ".json")
        join_objects(parts, wanted);
    else if (from == ".txt" && to == ".txt")
        join_texts(parts, wanted);
    else
        throw fail("-o {}: results that are {} are joined to {}; -o NAME/ keeps each by its name", wanted.output, from,
                   from == ".png"                                        ? "a .png, .mp4, .webm or .gif"
                   : from == ".csv" || from == ".json" || from == ".txt" ? "one " + from
                                                                         : std::string("nothing"));
    fmt::print(stderr, "wrote {}: {} tasks{}\n", wanted.output, parts.size(),
               missed ? fmt::format(", {} rows missed what they are held to", missed) : "");
    return missed ? 1 : 0;
}

} // namespace coif
