#pragma once
#include "sim/error.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace coif
{

// One line of a job list: a coif command that makes one file.
struct Task
{
    size_t number;                  // among the list's tasks, from 1; what is no task does not count
    size_t line;                    // of the file, from 1
    std::vector<std::string> words; // of the command, less what says where the result goes
    std::string name;               // of the result: what -o says, else "out" and the ending of what is printed
    bool prints = false;            // does the result go to standard output?

    std::string text() const; // as a line, for people
};

// A list that says what cannot be done. Nothing has been done then.
struct BadList : Error
{
    using Error::Error;
};

// Throws Error for words that coif would not take as a command, or whose style it cannot read.
using CheckLine = std::function<void(const std::vector<std::string>& words)>;

// A line's words, as a shell takes them apart: blanks between, '...' and "..." about, \ before what is meant as it is;
// from a # that begins a word the rest is a comment. What a shell would read something else from ($ * ; and so on,
// outside of quotes) throws Error with its column: a line must mean the same to every engine.
std::vector<std::string> words_of(const std::string& line);

// The word as such a line can hold it, in quotes if need be.
std::string quoted(const std::string& word);
std::string quoted(const std::vector<std::string>& words);

// The task that a line's words make; throws Error for one whose result cannot be one file of the batch's folder.
Task task_of(const std::vector<std::string>& words);

// Throws BadList with all that is wrong with a list, "jobs.txt:12: ...", a line each; `name` stands for its file.
std::vector<Task> parse_list(const std::string& text, const std::string& name, const CheckLine& check);
std::vector<Task> read_list(const std::filesystem::path& file, const CheckLine& check);

// Which tasks of a list are one machine's: those whose number is `index` modulo `count`. Neighbours cost alike, so each
// shard gets as much.
struct Shard
{
    size_t index = 0, count = 1;

    bool holds(const Task& task) const { return task.number % count == index; }
};

// "3/8". Throws Error.
Shard parse_shard(const std::string& text);

} // namespace coif
