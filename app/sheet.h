#pragma once
#include "app/image.h"
#include "app/lettering.h"
#include "app/shot.h"

#include <functional>
#include <optional>

namespace coif
{

struct SheetOptions
{
    std::vector<std::string> styles; // files, or names of presets
    std::optional<int> columns;      // unsaid: as many as fill the last row best
    std::optional<int> levels;       // each at every level of the look: samples a pixel of the traced one
};

// Where the cells of a contact sheet lie, row by row, in pixels. Under each picture is room for its name.
struct SheetLayout
{
    int columns, rows;
    int cell_width, cell_height; // of a picture
    int gap, letters;            // between cells and about all; height of a name's letters
    int width, height;           // of the sheet
    int lines;                   // of a name

    int line_height() const { return letters + letters / 4; }
    int label_height() const { return 2 * letters + (lines - 1) * line_height(); }
    int x(int cell) const { return gap + cell % columns * (cell_width + gap); }
    int y(int cell) const { return gap + cell / columns * (cell_height + label_height() + gap); }
};

// Throws Error for fewer than one column and for sheets too large to hold.
SheetLayout lay_out(int cells, std::optional<int> columns, int cell_width, int cell_height, int lines = 1);

// What stands under the cells: the styles' names, or, where two have the same, all of how they were called.
std::vector<std::string> sheet_labels(const std::vector<std::string>& styles);
std::vector<std::string> sheet_labels(const std::vector<std::string>& names, const std::vector<std::string>& calls);

// A sheet without a cell, and a cell into its place; without a picture it says so. A label may have as many lines as
// the sheet has room for.
constexpr Shade kPage = {24, 26, 30};
Image empty_sheet(const SheetLayout& at);
void put_cell(Image& sheet, const SheetLayout& at, int cell, const Image* picture, const std::string& label);

// Draws style `i`, or throws Error.
using DrawStyle = std::function<Image(size_t i)>;

// A contact sheet of styles into options.output, `cell` each, drawn here, one after another, or as `draw` does. A style
// that fails is told, and its cell says so. Returns the exit status: 1 if one failed. Throws Error when all did, or for
// what is wrong with all.
int sheet(const Options& options, const ShotOptions& cell, const SheetOptions& wanted, const DrawStyle& draw = {});

// Each style at every level of the look and traced, side by side, with its cost and its error (app/look_error.h): of
// light, before any display transform, so that it is the same whatever is shown. As sheet(), but for what fails.
int level_sheet(const Options& options, const ShotOptions& cell, const SheetOptions& wanted);

} // namespace coif
