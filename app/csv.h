#pragma once
#include <string>
#include <utility>
#include <vector>

namespace coif
{

// A field of a CSV file as RFC 4180 asks: in quotes where it holds a comma, a quote or the end of a line.
std::string csv_text(const std::string& text);

// In quotes, whatever it holds.
std::string csv_quoted(const std::string& text);

// The records of a file and their fields, without their quotes.
std::vector<std::vector<std::string>> csv_records(const std::string& text);

// Tables under each other, of which each has a name and its text. Throws Error naming two whose head lines differ.
std::string joined_csv(const std::vector<std::pair<std::string, std::string>>& tables);

} // namespace coif
