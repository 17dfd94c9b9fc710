#include "app/bench/rows.h"

#include "app/csv.h"
#include "app/json.h"
#include "app/table.h"

#include <fmt/format.h>

namespace coif
{

static std::string figure(double value, const char* form)
{
    return std::isnan(value) ? "" : fmt::format(fmt::runtime(form), value);
}

static std::string wanted(const BenchRow& row)
{
    if (!row.judged())
        return "";
    const std::string bound = std::isnan(row.most_ms) ? fmt::format("{:.3g} times faster", row.least_ratio)
                                                      : fmt::format("at most {:.3g} ms", row.most_ms);
    return fmt::format("{}: {}", bound, row.reached() ? "reached" : "MISSED");
}

std::string bench_table(const std::vector<BenchRow>& rows, const Machine& machine)
{
    std::vector<std::vector<std::string>> lines = {{"scene", "what", "strands", "cores", "ms", "quartiles", "ns/strand",
                                                    "of bandwidth", "of peak", "thesis' way, ms", "times faster",
                                                    "wanted"}};
    std::string last;
    for (const BenchRow& row : rows)
    {
        const std::string scene = row.scene + (row.note.empty() ? "" : ": " + row.note);
        if (scene + std::to_string(row.strands) != last && !last.empty())
            lines.emplace_back();
        last = scene + std::to_string(row.strands);
        lines.push_back(
            {scene, row.what, row.strands ? fmt::format("{}", row.strands) : "", fmt::format("{}", row.cores),
             figure(row.ms, "{:.3f}"), figure(row.low, "{:.3f}") + " - " + figure(row.high, "{:.3f}"),
             row.strands ? figure(1e6 * row.ms / row.strands, "{:.1f}") : "",
             figure(100.0 * row.of_bandwidth(machine), "{:.0f} %"), figure(100.0 * row.of_peak(machine), "{:.0f} %"),
             figure(row.baseline_ms, "{:.3f}"), figure(row.ratio(), "{:.2f}"), wanted(row)});
    }
    return fmt::format("{}\n{}, {} compute units, {} strands a work-item; {}\nlimits: {:.1f} GB/s read and written, "
                       "{:.1f} thousand million operations a second\n",
                       aligned(lines, {0, 1, 11}), machine.device, machine.compute_units, machine.width, machine.system,
                       1e-9 * machine.bandwidth, 1e-9 * machine.operations);
}

std::string bench_csv(const std::vector<BenchRow>& rows, const Machine& machine)
{
    std::string csv = "scene,note,what,strands,cores,ms,low_ms,high_ms,bytes,of_bandwidth,operations,of_peak,"
                      "baseline_ms,ratio,most_ms,least_ratio,reached\n";
    for (const BenchRow& row : rows)
        csv += fmt::format(
            "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_text(row.scene), csv_text(row.note),
            csv_text(row.what), row.strands, row.cores, figure(row.ms, "{:.6g}"), figure(row.low, "{:.6g}"),
            figure(row.high, "{:.6g}"), figure(row.bytes, "{:.6g}"), figure(row.of_bandwidth(machine), "{:.4g}"),
            figure(row.operations, "{:.6g}"), figure(row.of_peak(machine), "{:.4g}"), figure(row.baseline_ms, "{:.6g}"),
            figure(row.ratio(), "{:.4g}"), figure(row.most_ms, "{:.4g}"), figure(row.least_ratio, "{:.4g}"),
            !row.judged()   ? ""
            : row.reached() ? "yes"
                            : "no");
    return csv;
}

std::string bench_json(const std::vector<BenchRow>& rows, const Machine& machine)
{
    std::string json = fmt::format(
        "{{\"device\": {}, \"processor\": {}, \"system\": {}, \"compute_units\": {}, \"width\": {},\n"
        " \"bytes_per_second\": {}, \"operations_per_second\": {},\n \"rows\": [",
        json_text(machine.device), json_text(machine.processor), json_text(machine.system), machine.compute_units,
        machine.width, json_number(machine.bandwidth), json_number(machine.operations));
    const char* separator = "\n";
    for (const BenchRow& row : rows)
    {
        json += fmt::format(
            "{}  {{\"scene\": {}, \"note\": {}, \"what\": {}, \"strands\": {}, \"cores\": {}, \"ms\": {}, "
            "\"low_ms\": {}, \"high_ms\": {}, \"bytes\": {}, \"of_bandwidth\": {}, \"operations\": {}, \"of_peak\": "
            "{}, \"baseline_ms\": {}, \"ratio\": {}, \"most_ms\": {}, \"least_ratio\": {}, \"reached\": {}}}",
            separator, json_text(row.scene), json_text(row.note), json_text(row.what), row.strands, row.cores,
            json_number(row.ms), json_number(row.low), json_number(row.high), json_number(row.bytes),
            json_number(row.of_bandwidth(machine)), json_number(row.operations), json_number(row.of_peak(machine)),
            json_number(row.baseline_ms), json_number(row.ratio()), json_number(row.most_ms),
            json_number(row.least_ratio),
            !row.judged()   ? "null"
            : row.reached() ? "true"
                            : "false");
        separator = ",\n";
    }
    return json + "\n]}\n";
}

} // namespace coif
