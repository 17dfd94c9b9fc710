// Reading and writing single TOML values, with the place in the file for what is wrong.
#pragma once
#include "sim/error.h"
#include "sim/shown.h"

#include <filesystem>
#include <string>
#include <toml++/toml.h>

namespace coif
{

// "bob.toml:12:9"
inline std::string place(const std::filesystem::path& file, const toml::source_region& region)
{
    return fmt::format("{}:{}:{}", shown_file(file), region.begin.line, region.begin.column);
}

// Throws Error with the place for what is no TOML.
toml::table parse_toml(const std::string& text, const std::filesystem::path& file);

// What a value is, for errors: "a number".
const char* type_name(const toml::node& node);

// As many numbers as `count` from a list of just so many.
bool read_numbers(const toml::node& node, double* out, size_t count);

std::string float_text(float value); // shortest, and never a whole number's
std::string toml_string(const std::string& text);
std::string list_text(const float* values, size_t count); // "[0.5, 1.0]"

} // namespace coif
