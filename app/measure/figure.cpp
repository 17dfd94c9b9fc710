#include "app/measure/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace coif
{

// Okabe and Ito's palette, which colour-blind readers can tell apart.
static const char* const kPalette[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                       "#E69F00", "#56B4E9", "#000000", "#999933"};
static const int kPointTypes[] = {7, 5, 9, 13, 11, 4, 6, 8};

// A string of gnuplot's: in single quotes only the quote itself is special.
static std::string quoted(const std::string& text)
{
    std::string out = "'";
    for (const char c : text)
        out += c == '\'' ? std::string("''") : std::string(1, c == '\n' ? ' ' : c);
    return out + "'";
}

namespace
{
struct Range
{
    double low = std::numeric_limits<double>::infinity(), high = -low;
    void take(double v)
    {
        if (!std::isfinite(v))
            return;
        low = std::min(low, v);
        high = std::max(high, v);
    }
};
} // namespace

// Range and ticks of a logarithmic axis. Many decades carry one tick each, few 1, 2 and 5, and less than one still
// more.
static std::string log_axis(const char* axis, Range range)
{
    if (!(range.low > 0.0 && range.low <= range.high))
        return "";
    const double margin = std::max(1.15, std::pow(range.high / range.low, 0.06));
    const double low = range.low / margin, high = range.high * margin;
    const double decades = std::log10(high / low);
    std::vector<double> at;
    if (decades < 0.5) // a few round numbers
    {
        const double power = std::pow(10.0, std::floor(std::log10((high - low) / 3.0)));
        const double apart = (high - low) / (3.0 * power);
        const double step = power * (apart < 2.0 ? 1.0 : apart < 5.0 ? 2.0 : 5.0);
        for (double tick = std::ceil(low / step) * step; tick <= high; tick += step)
            at.push_back(tick);
    }
    else
        for (int e = int(std::floor(std::log10(low))); e <= int(std::ceil(std::log10(high))); ++e)
            for (const int m : {1, 2, 5})
                if (m == 1 || decades < 2.5)
                    at.push_back(m * std::pow(10.0, e));
    std::string ticks;
    for (const double tick : at)
        if (tick >= low && tick <= high)
            ticks += fmt::format("{}'{:.6g}' {:.6g}", ticks.empty() ? "" : ", ", tick, tick);
    return fmt::format("set logscale {0}\nset {0}range [{1:.6g}:{2:.6g}]\nset {0}tics ({3})\n", axis, low, high, ticks);
}

static std::string linear_axis(const char* axis, Range range)
{
    if (!(range.low <= range.high))
        return "";
    const double margin = range.high > range.low ? 0.06 * (range.high - range.low) : 0.5;
    return fmt::format("unset logscale {0}\nset {0}range [{1:.6g}:{2:.6g}]\nset {0}tics auto\n", axis,
                       range.low - margin, range.high + margin);
}

static std::string style_of(const Series& series)
{
    const size_t which = size_t(series.color) % std::size(kPalette);
    const char* color = kPalette[which];
    const int point = kPointTypes[which];
    switch (series.kind)
    {
    case Series::LINE:
        return "with lines linewidth 2 linecolor '#444444'";
    case Series::POINTS:
        return fmt::format("with points pointtype {} pointsize 0.9 linecolor '{}'", point, color);
    case Series::STAIR:
        return "with steps linewidth 7 linecolor '#DDDDDD'";
    case Series::GUIDE:
        return "with lines linewidth 1 dashtype 2 linecolor '#888888'";
    case Series::STAR:
        return fmt::format("with points pointtype 3 pointsize 1.8 linewidth 2 linecolor '{}'", color);
    case Series::LINE_AND_POINTS:
        break;
    }
    return fmt::format("with linespoints linewidth 1.6 pointtype {} pointsize 0.8 linecolor '{}'", point, color);
}

Plot figure(const std::string& name, const std::vector<Panel>& panels)
{
    const int columns = panels.size() < 2 ? 1 : panels.size() < 5 ? 2 : 3;
    const int rows = (int(panels.size()) + columns - 1) / columns;
    Plot plot{name, columns == 1 ? 640 : columns * 440, columns == 1 ? 480 : rows * 360, "", ""};
    if (panels.size() > 1)
        plot.body += fmt::format("set multiplot layout {},{}\n", rows, columns);
    plot.body += "set border 3 linecolor '#444444'\nset tics nomirror out scale 0.6 textcolor '#444444'\n"
                 "set grid linecolor '#EEEEEE' linetype 1\nset key tmargin center horizontal Left reverse noenhanced "
                 "samplen 1.6 maxcols 3 font ',10'\n";
    for (size_t p = 0; p < panels.size(); ++p)
    {
        const Panel& panel = panels[p];
        Range x, y;
        std::vector<std::string> curves;
        for (size_t s = 0; s < panel.series.size(); ++s)
        {
            const Series& series = panel.series[s];
            const std::string block = fmt::format("$panel{}_{}", p, s);
            plot.data += block + " << END\n";
            for (size_t i = 0; i < series.x.size(); ++i)
            {
                // Guides and fronts follow the data; they do not say how far it goes.
                if (series.kind != Series::GUIDE)
                {
                    x.take(series.x[i]);
                    y.take(series.y[i]);
                }
                plot.data += fmt::format("{:.6g} {:.6g} \"{}\"\n", series.x[i], series.y[i],
                                         i < series.labels.size() ? series.labels[i] : "");
            }
            plot.data += "END\n";
            // A guide is named where it ends, everything else in the key.
            const bool guide = series.kind == Series::GUIDE;
            curves.push_back(fmt::format("{} using 1:2 {} {}", block, style_of(series),
                                         guide ? "notitle" : "title " + quoted(series.title)));
            if (!series.labels.empty())
                curves.push_back(fmt::format("{} using 1:2:3 with labels {} font ',9' textcolor '#555555' notitle",
                                             block, guide ? "right offset 0,0.7" : "offset 0,0.7"));
        }
        plot.body += fmt::format("set title {} noenhanced offset 0,-0.5\nset xlabel {} noenhanced offset 0,0.3\nset "
                                 "ylabel {} noenhanced\n",
                                 quoted(panel.title), quoted(panel.x_label), quoted(panel.y_label));
        plot.body += panel.log_x ? log_axis("x", x) : linear_axis("x", x);
        plot.body += panel.log_y ? log_axis("y", y) : linear_axis("y", y);
        plot.body += fmt::format("plot {}\n", fmt::join(curves, ", \\\n     "));
    }
    if (panels.size() > 1)
        plot.body += "unset multiplot\n";
    return plot;
}

} // namespace coif
