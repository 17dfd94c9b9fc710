// Which figures there are, and which rows go where.
#include "app/measure/plots.h"
#include "app/measure/cantilever.h"
#include "app/measure/figure.h"
#include "app/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace coif
{

namespace
{
using Filter = std::function<bool(const Row&)>;
using Key = std::function<std::string(const Row&)>;
} // namespace

static double shown_error(const Row& row) { return (in_percent(row) ? 100.0 : 1.0) * row.error; }
static std::string error_label(const Row& row)
{
    return row.metric + (row.unit == "L"          ? ", % of the length"
                         : row.unit == "fraction" ? ", %"
                         : row.unit.empty()       ? ""
                                                  : ", " + row.unit);
}

// All keys, in the order of their first rows.
static std::vector<std::string> keys_of(const std::vector<Row>& rows, const Key& key)
{
    std::vector<std::string> keys;
    for (const Row& row : rows)
        if (std::find(keys.begin(), keys.end(), key(row)) == keys.end())
            keys.push_back(key(row));
    return keys;
}

static std::vector<Row> only(const std::vector<Row>& rows, const Filter& filter)
{
    std::vector<Row> kept;
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(kept), filter);
    return kept;
}

// One series a key, its points as `x` and `y` take them from the rows.
static void add_series(Panel& panel, const std::vector<Row>& rows, const Key& key,
                       const std::function<double(const Row&)>& x, const std::function<double(const Row&)>& y,
                       Series::Kind kind = Series::LINE_AND_POINTS)
{
    int color = 0;
    for (const std::string& title : keys_of(rows, key))
    {
        Series series{title, kind, color++, {}, {}, {}};
        for (const Row& row : rows)
            if (key(row) == title)
            {
                series.x.push_back(x(row));
                series.y.push_back(y(row));
            }
        panel.series.push_back(series);
    }
}

static Series front_of(const Panel& panel)
{
    std::vector<CostError> points;
    for (const Series& series : panel.series)
        for (size_t i = 0; i < series.x.size(); ++i)
            points.push_back({series.x[i], series.y[i]});
    Series front{"Pareto front", Series::STAIR, 0, {}, {}, {}};
    for (const size_t i : pareto_front(points))
    {
        front.x.push_back(points[i].cost);
        front.y.push_back(points[i].error);
    }
    return front;
}

// One knob of a strand, turned alone: sweeps.cpp.
static bool is_strand_sweep(const Row& row)
{
    const char* const ids[] = {"iterations", "substeps", "courant", "rate", "nodes"};
    return std::find(std::begin(ids), std::end(ids), row.scene) != std::end(ids);
}

static std::vector<Panel> error_cost(const std::vector<Row>& rows, bool solvers)
{
    std::vector<Panel> panels;
    // Sweeps of one knob are drawn over it. Below a millionth, models in double precision go on where float cannot.
    const auto priced = only(rows,
                             [solvers](const Row& r)
                             {
                                 return r.error > 1e-6 && r.ns_strand_frame > 0.0 && !r.at_least && r.scene != "grid" &&
                                        !is_strand_sweep(r) && (r.scene == "solver") == solvers;
                             });
    for (const std::string& scene : keys_of(priced, case_of))
    {
        std::vector<Row> own = only(priced, [&](const Row& r) { return case_of(r) == scene; });
        own = only(own,
                   [&](const Row& r) { return r.metric == own[0].metric; }); // a scene's first metric is its main one
        if (own.size() < 2)
            continue;
        Panel panel{
            solvers ? own[0].setting : scene, "cost, ns a strand and frame", error_label(own[0]), true, true, {}};
        add_series(
            panel, own, [](const Row& r) { return r.solver; }, [](const Row& r) { return r.ns_strand_frame; },
            shown_error);
        panel.series.insert(panel.series.begin(), front_of(panel));
        panels.push_back(panel);
    }
    return panels;
}

static std::vector<Panel> order(const std::vector<Row>& rows)
{
    std::vector<Panel> panels;
    const struct
    {
        const char *scene, *metric;
    } sweeps[] = {{"A10", "rms"}, {"A12", "median"}};
    for (const auto& sweep : sweeps)
    {
        const auto own = only(rows, [&](const Row& r)
                              { return r.scene == sweep.scene && r.metric == sweep.metric && r.error > 0.0; });
        if (own.size() < 2)
            continue;
        Panel panel{sweep.scene, own[0].knob, error_label(own[0]), true, true, {}};
        add_series(
            panel, own, [](const Row& r) { return r.solver + (r.setting.empty() ? "" : ", " + r.setting); },
            [](const Row& r) { return r.value; }, shown_error);
        double low = INFINITY, high = 0.0, least = INFINITY;
        for (const Row& row : own)
        {
            low = std::min(low, row.value);
            high = std::max(high, row.value);
            least = std::min(least, shown_error(row));
        }
        for (const int p : {1, 2}) // from below the least error
            panel.series.push_back({"",
                                    Series::GUIDE,
                                    0,
                                    {low, high},
                                    {0.7 * least, 0.7 * least * std::pow(high / low, p)},
                                    {"", fmt::format("order {}", p)}});
        panels.push_back(panel);
    }
    return panels;
}

static std::vector<Panel> cantilever(const std::vector<Row>& rows)
{
    const auto own =
        only(rows, [](const Row& r) { return r.scene == "A8" && r.metric == "H/W" && std::isfinite(r.measured); });
    if (own.empty())
        return {};
    Panel panel{"A8: droop of a cantilever", "Gamma = rho g S L^3 / (E I)", "H / W", true, true, {}};
    Series theory{"heavy elastica", Series::LINE, 0, {}, {}, {}};
    for (const Droop& droop : master_curve(0.05, 2000.0, 90))
    {
        theory.x.push_back(droop.gamma);
        theory.y.push_back(droop.ratio());
    }
    panel.series.push_back(theory);
    add_series(
        panel, own, [](const Row& r) { return r.solver + (r.setting.empty() ? "" : ", " + r.setting); },
        [](const Row& r) { return r.value; }, [](const Row& r) { return r.measured; }, Series::POINTS);
    return {panel};
}

static std::vector<Panel> picture(const std::vector<Row>& rows)
{
    std::vector<Panel> panels;
    const auto scored = only(rows, [](const Row& r) { return r.scene == "picture" && r.metric == "over hair"; });
    for (const std::string& style : keys_of(scored, [](const Row& r) { return r.setting; }))
    {
        const auto own = only(scored, [&](const Row& r) { return r.setting == style; });
        Panel panel{style, "milliseconds", "SSIM over hair", true, false, {}};
        add_series(
            panel, own, [](const Row& r) { return r.knob; }, [](const Row& r) { return r.ms; },
            [](const Row& r) { return r.error; });
        // Each point tells its knob's value, unless that would lie on another's.
        std::vector<CostError> told;
        for (Series& series : panel.series)
        {
            for (const Row& row : own)
                if (row.knob == series.title)
                {
                    const auto near = [&](const CostError& other) {
                        return std::abs(std::log(other.cost / row.ms)) < 0.15 &&
                               std::abs(other.error - row.error) < 0.04;
                    };
                    const bool room = std::isfinite(row.value) && std::none_of(told.begin(), told.end(), near);
                    series.labels.push_back(room ? fmt::format("{:g}", row.value) : "");
                    if (room)
                        told.push_back({row.ms, row.error});
                }
            if (series.x.size() == 1)
                series.kind = Series::STAR;
        }
        panels.push_back(panel);
    }
    return panels;
}

static std::vector<Panel> knobs(const std::vector<Row>& rows)
{
    std::vector<Panel> panels;
    const auto is_sweep = [](const Row& r) {
        return is_strand_sweep(r) || r.scene == "A12" || r.scene == "ratio" || r.scene == "grid" ||
               r.scene == "picture";
    };
    const auto turned =
        only(rows, [&](const Row& r) { return is_sweep(r) && std::isfinite(r.value) && std::isfinite(r.error); });
    const Key panel_of = [](const Row& r) { return r.scene + ": " + r.knob + " in " + r.unit; };
    for (const std::string& title : keys_of(turned, panel_of))
    {
        const auto own = only(turned, [&](const Row& r) { return panel_of(r) == title; });
        std::vector<double> values, errors;
        for (const Row& row : own)
        {
            values.push_back(row.value);
            errors.push_back(row.error);
        }
        std::sort(values.begin(), values.end());
        if (std::unique(values.begin(), values.end()) - values.begin() < 3)
            continue;
        const bool log_x = values.front() > 0.0 && values.back() >= 4.0 * values.front();
        const double least = *std::min_element(errors.begin(), errors.end());
        // A series is named by what tells it from the others.
        const auto several = [&own](const Key& key) { return keys_of(own, key).size() > 1; };
        const bool settings = several([](const Row&r) { return r.setting; }),
                   metrics = several([](const Row&r) { return r.metric; }),
                   solvers = several([](const Row&r) { return r.solver; });
        const Key series_of = [=](const Row& r)
        {
            std::string name;
            for (const auto& [told, word] :
                 {std::pair(settings, &r.setting), std::pair(metrics, &r.metric), std::pair(solvers, &r.solver)})
                if (told)
                    name += (name.empty() ? "" : ", ") + *word;
            return name.empty() ? r.metric : name;
        };
        const std::string& unit = own[0].unit;
        Panel panel{is_strand_sweep(own[0]) ? own[0].knob : own[0].scene + ": " + own[0].knob,
                    own[0].knob,
                    unit == "L"          ? "error, % of the length"
                    : unit == "fraction" ? "error, %"
                                         : unit,
                    log_x,
                    !own[0].at_least && least > 0.0,
                    {}};
        add_series(
            panel, own, series_of, [](const Row& r) { return r.value; }, shown_error);
        panels.push_back(panel);
    }
    return panels;
}

std::vector<Plot> plots_of(const std::vector<Row>& rows)
{
    std::vector<Plot> plots;
    const std::pair<const char*, std::vector<Panel>> all[] = {{"solvers", error_cost(rows, true)},
                                                              {"error_cost", error_cost(rows, false)},
                                                              {"order", order(rows)},
                                                              {"cantilever", cantilever(rows)},
                                                              {"picture", picture(rows)},
                                                              {"knobs", knobs(rows)}};
    for (const auto& [name, panels] : all)
        if (!panels.empty())
            plots.push_back(figure(name, panels));
    return plots;
}

} // namespace coif
