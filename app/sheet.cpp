#include "app/sheet.h"

#include "app/lettering.h"
#include "app/progress.h"
#include "sim/error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace coif
{

static constexpr Shade kName = {226, 228, 232}, kFailed = {240, 130, 110}, kNothing = {38, 41, 46};
static constexpr double kMostPixels = 8192.0 * 8192.0; // as a shot's; 256 MB
static constexpr double kLongestSide = 65535.0;

// From a square to three times as many columns as rows, with the fewest empty cells in the last row.
static int good_columns(int cells)
{
    int best = 1, least = cells;
    for (int columns = int(std::ceil(std::sqrt(cells))); columns <= int(1.8 * std::sqrt(cells)); ++columns)
        if (const int empty = (columns - cells % columns) % columns; empty < least)
        {
            best = columns;
            least = empty;
        }
    return best;
}

SheetLayout lay_out(int cells, std::optional<int> columns, int cell_width, int cell_height, int lines)
{
    if (columns && *columns < 1)
        throw fail("--columns {}: expected 1 or more", *columns);
    SheetLayout at = {};
    at.columns = columns ? std::min(*columns, cells) : good_columns(cells);
    at.rows = (cells + at.columns - 1) / at.columns;
    at.cell_width = cell_width;
    at.cell_height = cell_height;
    at.lines = lines;
    const int smaller = std::min(cell_width, cell_height);
    at.gap = std::max(2, smaller / 40);
    at.letters = std::clamp(smaller / 16, 11, 64);
    const double width = double(at.columns) * (cell_width + at.gap) + at.gap;
    const double height = double(at.rows) * (cell_height + at.label_height() + at.gap) + at.gap;
    if (width * height > kMostPixels || std::max(width, height) > kLongestSide)
        throw fail("a sheet of {} x {} cells would have {:.0f} x {:.0f} pixels, more than coif can hold; ask for fewer "
                   "styles or a smaller --size",
                   at.columns, at.rows, width, height);
    at.width = int(width);
    at.height = int(height);
    return at;
}

std::vector<std::string> sheet_labels(const std::vector<std::string>& styles)
{
    std::vector<std::string> names;
    for (const std::string& style : styles)
        names.push_back(std::filesystem::path(style).stem().string());
    return sheet_labels(names, styles);
}

std::vector<std::string> sheet_labels(const std::vector<std::string>& names, const std::vector<std::string>& calls)
{
    std::map<std::string, int> count;
    for (const std::string& name : names)
        ++count[name];
    std::vector<std::string> labels = names;
    for (size_t i = 0; i < names.size(); ++i)
        if (names[i].empty() || count[names[i]] > 1)
            labels[i] = calls[i];
    return labels;
}

static void write_centered(Image& sheet, const TextLine& line, int x, int width, int y, Shade shade)
{
    write_line(sheet, line, x + (width - line.width) / 2, y, shade);
}

Image empty_sheet(const SheetLayout& at)
{
    Image page{at.width, at.height, std::vector<unsigned char>(size_t(4) * size_t(at.width) * size_t(at.height))};
    fill(page, 0, 0, at.width, at.height, kPage);
    return page;
}

void put_cell(Image& page, const SheetLayout& at, int cell, const Image* picture, const std::string& label)
{
    const int x = at.x(cell), y = at.y(cell);
    if (picture)
        paste(page, *picture, x, y);
    else
    {
        fill(page, x, y, at.cell_width, at.cell_height, kNothing);
        write_centered(page, line_of("no picture", at.letters, at.cell_width), x, at.cell_width,
                       y + (at.cell_height - at.letters) / 2, kFailed);
    }
    std::istringstream lines(label);
    std::string line;
    for (int below = y + at.cell_height + at.letters / 2; std::getline(lines, line); below += at.line_height())
        write_centered(page, line_of(line, at.letters, at.cell_width), x, at.cell_width, below,
                       picture ? kName : kFailed);
}

int sheet(const Options& options, const ShotOptions& cell, const SheetOptions& wanted, const DrawStyle& draw)
{
    check_shot(options, cell);
    const SheetLayout at = lay_out(int(wanted.styles.size()), wanted.columns, cell.width, cell.height);
    check_folder(options.output);
    Hairstyle any;
    for (const std::string& set : options.sets)
        assign(any, set); // what is wrong with all is said once
    const Motion motion = find_motion(options.motion);
    std::optional<Window> window;
    if (!draw)
        window.emplace(16, 16, Window::HIDDEN);
    const Device device = shared_with_gl(open_device(options));
    // Each has a studio of its own: what one leaves behind must not show in the next.
    const auto draw_here = [&](size_t i)
    {
        Options one = options;
        one.style = wanted.styles[i];
        Studio studio(device, load_style(one), motion, cell);
        studio.play_to(options.seconds);
        return studio.picture();
    };
    const std::vector<std::string> labels = sheet_labels(wanted.styles);

    Image page = empty_sheet(at);
    Progress progress;
    size_t failed = 0;
    for (size_t i = 0; i < labels.size(); ++i)
    {
        std::optional<Image> picture;
        progress.say(fmt::format("{} ({} of {})", labels[i], i + 1, labels.size()));
        try
        {
            if (wanted.styles[i].empty())
                throw Error("sheet: a style without a name");
            picture = draw ? draw(i) : draw_here(i);
        }
        catch (const Error& e)
        {
            progress.clear();
            const std::string why = e.what();
            fmt::print(stderr, "coif: {}{}\n", why.find(labels[i]) == why.npos ? labels[i] + ": " : "", why);
            ++failed;
        }
        put_cell(page, at, int(i), picture ? &*picture : nullptr, labels[i]);
    }
    progress.clear();
    if (failed == labels.size())
        throw fail("{}: none of the styles could be drawn, so there is no sheet", options.output);
    save_png(options.output, page);
    fmt::print(stderr, "wrote {}: {} of {} styles\n", options.output, labels.size() - failed, labels.size());
    return failed ? 1 : 0;
}

} // namespace coif
