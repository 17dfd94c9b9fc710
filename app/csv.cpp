#include "app/csv.h"

#include "sim/error.h"

#include <algorithm>

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

std::vector<std::vector<std::string>> csv_records(const std::string& text)
{
    std::vector<std::vector<std::string>> records;
    std::vector<std::string> fields;
    std::string field;
    bool in_quotes = false, begun = false;
    const auto end_record = [&]
    {
        if (begun)
        {
            fields.push_back(field);
            records.push_back(fields);
        }
        fields.clear();
        field.clear();
        begun = false;
    };
    for (size_t i = 0; i < text.size(); ++i)
    {
        const char c = text[i];
        const bool doubled = in_quotes && c == '"' && i + 1 < text.size() && text[i + 1] == '"';
        if (!in_quotes && c == '\n')
        {
            end_record();
            continue;
        }
        begun = true;
        if (doubled)
            field += text[i++];
        else if (c == '"')
            in_quotes = !in_quotes;
        else if (!in_quotes && c == ',')
        {
            fields.push_back(field);
            field.clear();
        }
        else if (in_quotes || c != '\r')
            field += c;
    }
    end_record();
    return records;
}

static std::string head_of(const std::string& table)
{
    return table.substr(0, std::min(table.find('\n'), table.size()));
}

std::string joined_csv(const std::vector<std::pair<std::string, std::string>>& tables)
{
    std::string out;
    for (const auto& [name, text] : tables)
    {
        const std::string head = head_of(text);
        if (head != head_of(tables[0].second))
            throw fail("{} and {} are tables of different columns, and cannot be one: \"{}\" and \"{}\"",
                       tables[0].first, name, head_of(tables[0].second), head);
        out += out.empty() ? text : text.substr(std::min(head.size() + 1, text.size()));
        if (!out.ends_with('\n'))
            out += '\n';
    }
    return out;
}

} // namespace coif
