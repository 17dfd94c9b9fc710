#include "app/measure/rows.h"

#include "app/csv.h"
#include "app/json.h"
#include "app/table.h"

#include <fmt/format.h>

#include <cstdlib>

namespace coif
{

// The columns of both files, once. `text` or `number` says what a column is.
static const struct Column
{
    const char* name;
    std::string Row::*text;
    double Row::*number;
} kColumns[] = {{"scene", &Row::scene, nullptr},
                {"setting", &Row::setting, nullptr},
                {"metric", &Row::metric, nullptr},
                {"solver", &Row::solver, nullptr},
                {"knob", &Row::knob, nullptr},
                {"value", nullptr, &Row::value},
                {"measured", nullptr, &Row::measured},
                {"error", nullptr, &Row::error},
                {"unit", &Row::unit, nullptr},
                {"reference", &Row::reference, nullptr},
                {"stretch_max", nullptr, &Row::stretch},
                {"penetration_mm", nullptr, &Row::penetration_mm},
                {"ns_strand_frame", nullptr, &Row::ns_strand_frame},
                {"ms", nullptr, &Row::ms},
                {"pass", nullptr, &Row::pass},
                {"state_of_the_art", nullptr, &Row::state_of_the_art}};

std::string case_of(const Row& row) { return row.scene + (row.setting.empty() ? "" : " " + row.setting); }

bool in_percent(const Row& row) { return row.unit == "L" || row.unit == "fraction"; }

static std::string verdict(const Row& row)
{
    if (!row.judged())
        return "";
    return !row.passed() ? "MISSED" : row.excels() ? "excellent" : "pass";
}

std::string csv_of(const std::vector<Row>& rows)
{
    std::string out;
    for (const Column& column : kColumns)
        out += fmt::format("{},", column.name);
    out += "verdict\n";
    for (const Row& row : rows)
    {
        for (const Column& column : kColumns)
            if (column.text)
                out += csv_text(row.*column.text) + ",";
            else
                out += std::isfinite(row.*column.number) ? fmt::format("{:.6g},", row.*column.number) : ",";
        out += verdict(row) + "\n";
    }
    return out;
}

std::vector<Row> rows_of(const std::string& csv)
{
    std::vector<Row> rows;
    const auto records = csv_records(csv);
    for (size_t r = 1; r < records.size(); ++r)
    {
        Row row;
        for (size_t c = 0; c < std::size(kColumns); ++c)
        {
            const std::string field = c < records[r].size() ? records[r][c] : "";
            if (kColumns[c].text)
                row.*kColumns[c].text = field;
            else if (!field.empty())
                row.*kColumns[c].number = std::strtod(field.c_str(), nullptr);
        }
        // The one thing that no column says, the verdict tells.
        row.at_least = row.judged() && row.passed() == (records[r].back() == "MISSED");
        rows.push_back(row);
    }
    return rows;
}

std::string json_of(const std::vector<Row>& rows, const std::string& device, bool quick)
{
    std::string out =
        fmt::format("{{\"version\": 1, \"device\": {}, \"quick\": {}, \"rows\": [", json_text(device), quick);
    for (size_t i = 0; i < rows.size(); ++i)
    {
        out += i ? ",\n  {" : "\n  {";
        for (const Column& column : kColumns)
            out += fmt::format("\"{}\": {}, ", column.name,
                               column.text ? json_text(rows[i].*column.text) : json_number(rows[i].*column.number));
        out += fmt::format("\"verdict\": {}}}", rows[i].judged() ? json_text(verdict(rows[i])) : "null");
    }
    return out + "\n]}\n";
}

// Four significant digits, or nothing.
static std::string shown(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : ""; }

static std::string shown_error(const Row& row)
{
    if (!std::isfinite(row.error))
        return "-";
    if (in_percent(row))
        return fmt::format("{:.3g} %{}", 100.0 * row.error, row.unit == "L" ? " L" : "");
    return fmt::format("{:.4g}{}{}", row.error, row.unit.empty() ? "" : " ", row.unit);
}

std::string table_of(const std::vector<Row>& rows)
{
    std::vector<std::vector<std::string>> lines = {
        {"scene", "metric", "solver", "knob", "value", "error", "stretch", "inside", "ns/strand", "ms", ""}};
    for (const Row& row : rows)
        lines.push_back({case_of(row), row.metric, row.solver, row.knob, shown(row.value), shown_error(row),
                         std::isfinite(row.stretch) ? fmt::format("{:.2f} %", 100.0 * row.stretch) : "",
                         std::isfinite(row.penetration_mm) ? fmt::format("{:.2f} mm", row.penetration_mm) : "",
                         shown(row.ns_strand_frame), shown(row.ms), verdict(row)});
    return aligned(lines, {0, 1, 2, 3, lines[0].size() - 1});
}

} // namespace coif
