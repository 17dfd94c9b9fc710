#pragma once
#include "sim/error.h"
#include "sim/params.h"

#include <filesystem>
#include <map>
#include <string>

namespace coif
{

// A hairstyle file in memory. Keys that a file leaves out keep the defaults of kernels/params.def; a key that no
// parameter answers to is an error, so that a slip never passes for a default.
struct Hairstyle
{
    std::filesystem::path file;                // empty for one that was never saved
    std::string text;                          // as read, so that a save keeps comments and order
    std::map<std::string, std::string> places; // "scalp.mesh" -> "bob.toml:3:8", for errors told later
    HairParams params;
    HostParams host;
    // [variant.NAME]: what differs from the style itself under that name. While one of them is on, `params` are its,
    // and `own` are the style's.
    std::map<std::string, std::vector<Setting>> variants;
    std::string variant; // that is on; empty: none
    HairParams own;

    std::string name() const { return file.empty() ? "untitled" : file.stem().string(); }
};

// What `action` returns; an Error that it throws is told with the place where the style says `key`.
template <typename Action> auto placed(const Hairstyle& style, const std::string& key, Action action)
{
    try
    {
        return action();
    }
    catch (const Error& e)
    {
        const auto at = style.places.find(key);
        throw fail("{}{}", at == style.places.end() ? "" : at->second + ": ", e.what());
    }
}

// Throws Error "bob.toml:12:9: strand.length is -1, but must lie in [0.002, 1.5] m".
Hairstyle load_hairstyle(const std::filesystem::path& file);
// `beside`: also what lies in files beside it, strand shapes and large maps.
Hairstyle parse_hairstyle(const std::string& text, const std::filesystem::path& file, bool beside = true);

// `[[collider]]` entries of a file of their own, as head.spheres names. Throws Error as load_hairstyle().
std::vector<Collider> load_colliders(const std::filesystem::path& file);

// "strand.length=0.2", as --set takes it; the value is TOML, or a bare word for texts, choices and colours.
void assign(Hairstyle& style, const std::string& assignment);

// The TOML text of a value: shortest floats, "#rrggbb" for colours that are bytes, labels for choices.
std::string value_text(const Hairstyle& style, const ParamInfo& info);

// Turns a variant on, in place of the one that is, or none with an empty name; edits to the old one stay in it. Throws
// Error naming those there are.
void switch_variant(Hairstyle& style, const std::string& name);
// Keeps all numbers as they are now under a name, as what differs from the style as it was written, and turns that on.
// Throws Error for a name that is no TOML key.
void take_variant(Hairstyle& style, const std::string& name);
// The variants with the one that is on as it is now.
std::map<std::string, std::vector<Setting>> current_variants(const Hairstyle& style);
// The same variants with the same in them, and the same one on?
bool same_variants(const Hairstyle& a, const Hairstyle& b);
// Numbers and lists alike, and variants too?
bool same_style(const Hairstyle& a, const Hairstyle& b);

bool same_value(const Hairstyle& a, const Hairstyle& b, const ParamInfo& info);
void copy_value(const Hairstyle& from, Hairstyle& to, const ParamInfo& info);

// The file as it is to be saved at `target`: style.text with only what changed rewritten, or only what differs from the
// defaults if it has no text. Relative paths are made relative to the target's folder.
std::string hairstyle_text(const Hairstyle& style, const std::filesystem::path& target);

// Saves beside the target and renames over it, so that a crash leaves the old file or the new one.
void save_hairstyle(Hairstyle& style, const std::filesystem::path& target);

// Writes `bytes` beside `file` and renames over it. Throws Error when the folder cannot be written.
void write_file(const std::filesystem::path& file, const std::string& bytes);

// Makes a folder and those above it, where there are none. Throws Error when it cannot.
void make_folder(const std::filesystem::path& folder);

// Throws Error for what is missing, and for folders, pipes and devices, which are read to no end or not at all.
void check_regular(const std::filesystem::path& file);

// Reads a whole file. Throws Error as check_regular(), and for one that is larger than `limit` bytes.
std::string read_file(const std::filesystem::path& file, size_t limit = size_t(1) << 30);

// Throws Error for TOML with keys of thousands of dots: toml++ 3.3 makes a table in a table of each, and runs out of
// stack when it takes them down again.
void refuse_deep_keys(const std::string& text, const std::filesystem::path& file);

// Where a path written in `style` lies: beside the style, else in coif's data folder `shipped` (hairstyles/, assets/,
// assets/motions/ are asked by the caller). Throws Error with the place of `key` and both places that were looked at.
std::filesystem::path resolve_path(const Hairstyle& style, const std::string& key, const std::string& written,
                                   const std::filesystem::path& shipped);

// Where the file lies that the style's TEXT `key` names, as resolve_path() finds it; shipped are lights among
// hairstyles/lights/, all else among assets/.
std::filesystem::path named_file(const Hairstyle& style, const std::string& key, const std::string& written);

} // namespace coif
