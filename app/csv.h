#pragma once
#include <string>

namespace coif
{

// A field of a CSV file as RFC 4180 asks: in quotes where it holds a comma, a quote or the end of a line.
std::string csv_text(const std::string& text);

// In quotes, whatever it holds.
std::string csv_quoted(const std::string& text);

} // namespace coif
