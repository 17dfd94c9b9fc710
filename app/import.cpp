#include "app/import.h"

#include "sim/exchange/place.h"
#include "sim/scatter.h"
#include "sim/simulation.h"
#include "sim/source.h"

#include <algorithm>
#include <cmath>

namespace coif
{

namespace fs = std::filesystem;

// Up to so many strands a file's hair is simulated strand by strand, which loses nothing of it.
static constexpr size_t kAllSimulated = 20000;

bool is_hair_file(const fs::path& file)
{
    std::string suffix = file.extension().string();
    std::ranges::transform(suffix, suffix.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    constexpr const char* kSuffixes[] = {".abc", ".hair", ".usda", ".usd", ".usdc", ".usdz", ".tfx", ".data"};
    return std::ranges::any_of(kSuffixes, [&](const char* one) { return suffix == one; });
}

// Strands whose tips are this share of their length above their roots stand up. A stalk can where its droop number is
// less than 7.8 (Greenhill, Determination of the greatest height consistent with stability, 1881); hair as limp as the
// default falls over, however it was combed.
static constexpr float kStands = 0.3f, kStandingDroop = 4.0f;

static size_t standing_strands(const PlacedHair& hair)
{
    size_t standing = 0;
    for (size_t s = 0; s < hair.strands(); ++s)
        standing += hair.position[hair.first[s + 1] - 1].y > kStands * hair.length(s);
    return standing;
}

// IEC 61966-2-1, to the byte, as styles write colours.
static float srgb_byte(float linear)
{
    const float l = std::clamp(linear, 0.0f, 1.0f);
    const float s = l <= 0.0031308f ? 12.92f * l : 1.055f * std::pow(l, 1.0f / 2.4f) - 0.055f;
    return std::round(s * 255.0f) / 255.0f;
}

static float4 color_of(glm::vec3 sum, size_t count)
{
    const glm::vec3 mean = sum / float(count);
    return F4(srgb_byte(mean.x), srgb_byte(mean.y), srgb_byte(mean.z), 1.0f);
}

Hairstyle imported_style(const fs::path& file, const fs::path& target, const ImportOptions& options,
                         std::string& report)
{
    const HairFile hair = read_hair_file(file);
    Hairstyle style;
    style.file = target;
    HairParams& p = style.params;
    std::error_code error;
    const fs::path folder = fs::weakly_canonical(fs::absolute(target).parent_path(), error);
    style.host.groom_import = fs::weakly_canonical(fs::absolute(file), error).lexically_relative(folder).string();
    if (!options.scalp.empty())
        style.host.scalp_mesh = options.scalp;
    if (!options.up.empty())
        assign(style, "groom.import_up=" + options.up);
    if (options.scale != 0.0)
        assign(style, fmt::format("groom.import_scale={}", options.scale));
    const Curves& c = hair.curves;
    // Strands that are drawn as they are need no more variety.
    const bool many = c.strands() >= size_t(p.groom_import_guides);
    if (many)
    {
        p.interpolation_strands = int(std::min<size_t>(c.strands(), 200000));
        p.strand_length_variation = 0.0f;
        p.interpolation_guides = c.strands() <= kAllSimulated ? GUIDES_ALL : GUIDES_VERTICES;
    }
    if (!c.color.empty())
    {
        glm::vec3 roots(0.0f), tips(0.0f);
        for (size_t s = 0, at = 0; s < c.strands(); at += c.count[s++])
        {
            roots += c.color[at];
            tips += c.color[at + c.count[s] - 1];
        }
        p.look_root_color = color_of(roots, c.strands());
        p.look_tip_color = color_of(tips, c.strands());
    }
    for (const std::string& set : options.sets)
        assign(style, set);
    const Scalp scalp = load_scalp(resolve_path(style, "scalp.mesh", style.host.scalp_mesh, data_folder() / "assets"));
    std::string said, moved;
    const HairFrame frame = hair_frame(hair, scalp, p, said);
    if (const glm::vec3 by = fitting_offset(hair, frame, scalp); by != glm::vec3(0.0f))
    {
        p.groom_import_offset = F4(frame.offset.x + by.x, frame.offset.y + by.y, frame.offset.z + by.z, 0.0f);
        moved =
            fmt::format("its roots lay elsewhere, and were moved by [{:.3f}, {:.3f}, {:.3f}] m so that their middle "
                        "is the scalp's: see whether that is right\n",
                        by.x, by.y, by.z);
    }
    const PlacedHair placed = place_hair(hair, scalp, p);
    // Lengths that regions and maps tell are against this one.
    p.strand_length = std::clamp(std::round(placed.mean * 1000.0f) / 1000.0f, 0.002f, 1.5f);
    report = import_report(placed, p) + moved;
    const bool droop_told =
        std::ranges::any_of(options.sets, [](const std::string& set) { return set.starts_with("bending."); });
    if (const size_t standing = standing_strands(placed); 10 * standing > placed.strands() && !droop_told)
    {
        p.bending_droop = kStandingDroop;
        report += fmt::format("{} of its strands stand up, which limp hair does not: bending.droop is set to {}\n",
                              standing, kStandingDroop);
    }
    return style;
}

} // namespace coif
