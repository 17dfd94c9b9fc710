#include "app/lettering.h"

#include <imgui.h>
#include <imgui_internal.h> // the UTF-8 decoder

#include <algorithm>
#include <cassert>
#include <cmath>

namespace coif
{

std::filesystem::path font_file()
{
    std::error_code error;
    for (const char* font :
         {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/dejavu/DejaVuSans.ttf"})
        if (std::filesystem::exists(font, error))
            return font;
    return {};
}

static ImFont* add_font(ImFontAtlas& atlas, const ImVector<ImWchar>& letters, int pixels)
{
    ImFontConfig config;
    config.OversampleH = config.OversampleV = 1; // a pixel of the atlas is one of the picture
    config.PixelSnapH = true;
    config.GlyphRanges = letters.Data;
    const std::filesystem::path file = font_file();
    if (!file.empty())
        return atlas.AddFontFromFileTTF(file.c_str(), float(pixels), &config);
    config.SizePixels = 13.0f * float(std::max(1, (pixels + 6) / 13)); // it is drawn for multiples of 13
    return atlas.AddFontDefault(&config);
}

static std::vector<ImWchar> letters_of(const std::string& text)
{
    std::vector<ImWchar> letters;
    const char* end = text.data() + text.size();
    for (const char* at = text.data(); at < end;)
    {
        unsigned letter = 0;
        at += std::max(1, ImTextCharFromUtf8(&letter, at, end));
        letters.push_back(letter >= 0x20 && letter <= IM_UNICODE_CODEPOINT_MAX ? ImWchar(letter) : ImWchar('?'));
    }
    return letters;
}

TextLine line_of(const std::string& text, int pixels, int most)
{
    std::vector<ImWchar> letters = letters_of(text);
    ImFontGlyphRangesBuilder needed;
    needed.AddText("?.");
    for (const ImWchar letter : letters)
        needed.AddChar(letter);
    ImVector<ImWchar> ranges;
    needed.BuildRanges(&ranges);
    ImFontAtlas atlas;
    atlas.Flags |= ImFontAtlasFlags_NoMouseCursors | ImFontAtlasFlags_NoBakedLines;
    const ImFont* font = add_font(atlas, ranges, pixels);
    unsigned char* covered = nullptr;
    int atlas_width = 0, atlas_height = 0;
    atlas.GetTexDataAsAlpha8(&covered, &atlas_width, &atlas_height);

    const auto glyph_of = [&](ImWchar letter)
    {
        const ImFontGlyph* glyph = font->FindGlyphNoFallback(letter);
        return glyph ? glyph : font->FindGlyph('?');
    };
    const auto width_of = [&](const std::vector<ImWchar>& all)
    {
        float width = 0.0f;
        for (const ImWchar letter : all)
            width += glyph_of(letter)->AdvanceX;
        return int(std::ceil(width));
    };
    for (size_t kept = letters.size(); width_of(letters) > most && kept > 0;)
    {
        letters.resize(--kept);
        letters.insert(letters.end(), 3, ImWchar('.'));
    }

    TextLine line{std::min(width_of(letters), most), int(std::ceil(font->FontSize)), {}};
    line.coverage.resize(size_t(std::max(line.width, 0)) * size_t(line.height));
    float pen = 0.0f;
    for (const ImWchar letter : letters)
    {
        const ImFontGlyph& glyph = *glyph_of(letter);
        const int left = int(std::lround(pen + glyph.X0)), top = int(std::lround(glyph.Y0));
        const int from_x = int(std::lround(glyph.U0 * float(atlas_width)));
        const int from_y = int(std::lround(glyph.V0 * float(atlas_height)));
        for (int y = 0; y < int(std::lround(glyph.Y1 - glyph.Y0)); ++y)
            for (int x = 0; x < int(std::lround(glyph.X1 - glyph.X0)); ++x)
            {
                if (left + x < 0 || left + x >= line.width || top + y < 0 || top + y >= line.height)
                    continue;
                unsigned char& to = line.coverage[size_t(top + y) * size_t(line.width) + size_t(left + x)];
                to = std::max(to, covered[size_t(from_y + y) * size_t(atlas_width) + size_t(from_x + x)]);
            }
        pen += glyph.AdvanceX;
    }
    return line;
}

void write_line(Image& image, const TextLine& line, int x, int y, Shade shade)
{
    for (int row = std::max(0, -y); row < std::min(line.height, image.height - y); ++row)
        for (int column = std::max(0, -x); column < std::min(line.width, image.width - x); ++column)
        {
            const int share = line.coverage[size_t(row) * size_t(line.width) + size_t(column)];
            unsigned char* to = &image.pixels[size_t(4) * (size_t(y + row) * size_t(image.width) + size_t(x + column))];
            for (const auto& [at, color] : {std::pair(0, shade.r), {1, shade.g}, {2, shade.b}, {3, 255}})
                to[at] = static_cast<unsigned char>((int(color) * share + int(to[at]) * (255 - share) + 127) / 255);
        }
}

void fill(Image& image, int x, int y, int width, int height, Shade shade)
{
    assert(x >= 0 && y >= 0 && x + width <= image.width && y + height <= image.height);
    for (int row = y; row < y + height; ++row)
        for (int column = x; column < x + width; ++column)
        {
            unsigned char* to = &image.pixels[size_t(4) * (size_t(row) * size_t(image.width) + size_t(column))];
            to[0] = shade.r;
            to[1] = shade.g;
            to[2] = shade.b;
            to[3] = 255;
        }
}

void paste(Image& image, const Image& part, int x, int y)
{
    assert(x >= 0 && y >= 0 && x + part.width <= image.width && y + part.height <= image.height);
    for (int row = 0; row < part.height; ++row)
        std::copy_n(&part.pixels[size_t(4) * size_t(row) * size_t(part.width)], size_t(4) * size_t(part.width),
                    &image.pixels[size_t(4) * (size_t(y + row) * size_t(image.width) + size_t(x))]);
}

} // namespace coif
