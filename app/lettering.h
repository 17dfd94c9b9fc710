#pragma once
#include "app/image.h"

#include <string>

namespace coif
{

// The font that windows and labels are written in; an empty path where it is not installed, and then Dear ImGui's own
// serves.
std::filesystem::path font_file();

// One line of text: how much of each pixel it covers, 0 to 255, top row first.
struct TextLine
{
    int width = 0, height = 0;
    std::vector<unsigned char> coverage;
};

// UTF-8 text, letters about `pixels` high. A line wider than `most` pixels ends in dots instead; what the font lacks
// becomes a question mark.
TextLine line_of(const std::string& text, int pixels, int most);

struct Shade // sRGB
{
    unsigned char r, g, b;
};

// Draws the line with its upper left corner at (x, y). What sticks out of the picture is cut off.
void write_line(Image& image, const TextLine& line, int x, int y, Shade shade);

// Fills a part that lies within the picture.
void fill(Image& image, int x, int y, int width, int height, Shade shade);

// Puts a whole picture into a larger one, its upper left corner at (x, y).
void paste(Image& image, const Image& part, int x, int y);

} // namespace coif
