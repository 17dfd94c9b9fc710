#include "app/csv.h"

namespace coif
{

std::string csv_quoted(const std::string& text)
{
    std::string out = "\"";
    for (const char c : text)
        out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

std::string csv_text(const std::string& text)
{
    return text.find_first_of(",\"\r\n") == text.npos ? text : csv_quoted(text);
}

} // namespace coif
