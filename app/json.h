#pragma once
#include <string>

namespace coif
{

// `text` in quotes, escaped as RFC 8259 asks.
std::string json_text(const std::string& text);

// Six digits; null for what is not finite, of which JSON has none.
std::string json_number(double value);

} // namespace coif
