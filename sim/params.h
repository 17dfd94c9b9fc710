#pragma once
#include "kernels/shared.h"
#include "sim/lists.h"
#include "sim/strand_shapes.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace coif
{

#define COIF_MEMBER_TEXT(group, name, value) std::string group##_##name = value;
#define COIF_MEMBER_SHAPE(group, name, value) StoredShape group##_##name;
#define COIF_MEMBER_LIST(group, name, value) std::vector<group##_entry> group##s;
#define COIF_PARAM(group, kind, name, value, lo, hi, unit, scope, effect, read_by, labels, help)
#define COIF_HOST(group, kind, name, value, scope, effect, help) COIF_MEMBER_##kind(group, name, value)

// What an artist authors that never reaches the device: paths as they stand in the file, and lists.
struct HostParams
{
#include "kernels/params.def"
    bool operator==(const HostParams&) const = default;
};
#undef COIF_HOST

enum class Kind
{
    FLOAT,
    INT,
    CHOICE,
    VECTOR,
    COLOR,
    PROFILE,
    TEXT,
    SHAPE,
    LIST
};
enum class Scope
{
    GLOBAL,
    STRAND,
    PROFILE
};
enum class Effect
{
    LIVE,
    VIEW,
    REGROW,
    REBUILD
};
enum class ReadBy
{
    ALL,
    DIRECT,
    PBD,
    THESIS,
    FIBRE,
    AUTO,
    MELANIN,
    AROUND
};

// look.level
enum LookLevel
{
    LOOK_AUTO,
    LOOK_KAJIYA_KAY,
    LOOK_KARIS,
    LOOK_FAR_FIELD,
    LOOK_DUAL_SCATTERING
};

constexpr int kMostNumbers = 4; // of a parameter

// One line of kernels/params.def, as data. Whatever handles parameters walks this table, so that nothing of it changes
// when a parameter is added.
struct ParamInfo
{
    const char* group;
    const char* name;
    Kind kind;
    Scope scope;
    Effect effect;
    ReadBy read_by;
    size_t offset; // into HairParams, or into HostParams for TEXT, SHAPE and LIST
    float min, max;
    const char* unit;
    const char* labels; // of a CHOICE, separated by |
    const char* help;

    std::string path() const { return *name ? std::string(group) + "." + name : group; }
    bool on_host() const { return kind == Kind::TEXT || kind == Kind::SHAPE || kind == Kind::LIST; }
    int components() const { return kind == Kind::PROFILE ? 4 : kind == Kind::VECTOR || kind == Kind::COLOR ? 3 : 1; }
};

// What `action` gives for the list of `host` that a LIST stands for.
#define COIF_WITH_TEXT(list)
#define COIF_WITH_SHAPE(list)
#define COIF_WITH_LIST(list)                                                                                           \
    if (info.group == std::string_view(#list))                                                                         \
        return action(host.list##s);
#define COIF_HOST(group, kind, name, value, scope, effect, help) COIF_WITH_##kind(group)
template <typename Host, typename Action> auto with_list(Host& host, const ParamInfo& info, Action action)
{
#include "kernels/params.def"
    return action(host.colliders); // not reached
}
#undef COIF_PARAM
#undef COIF_HOST

// Entries of a LIST.
size_t list_size(const HostParams& host, const ParamInfo& info);

std::span<const ParamInfo> param_table();
const char* kind_name(Kind kind);
const char* scope_name(Scope scope);
const char* effect_name(Effect effect);

// Is hair lit as the thesis does it? At the other levels too, where its colours tell something else (render.colors).
bool lit_by_kajiya_kay(const HairParams& params);

// Has what `params` chooses a use for this parameter?
bool is_read(const ParamInfo& info, const HairParams& params);

// What must be so for that: "solver.kind is pbd"; "" where it is always read.
std::string only_reader(const ParamInfo& info);

// "strand.length" -> its line, or null.
const ParamInfo* find_param(std::string_view path);

// The known path that is fewest edits (Levenshtein 1966) away from `path`.
std::string nearest_param(std::string_view path);

// "a|b" -> a, b.
std::vector<std::string> split_labels(std::string_view labels);

// The labels of a CHOICE, in order.
std::vector<std::string> param_labels(const ParamInfo& info);

// Authored numbers of a parameter that crosses to the device; VECTOR and COLOR fill three, PROFILE four.
void get_numbers(const HairParams& params, const ParamInfo& info, float out[kMostNumbers]);

// Takes them after checking. Throws Error "strand.length is -1, but must lie in [0.002, 1.5] m".
void set_numbers(HairParams& params, const ParamInfo& info, const double values[kMostNumbers]);

// A profile at `along` (0 at the root, 1 at the tip): kernels/strand_curve.h, said again in double for the host.
double profile_at(const float4& profile, double along);
float most_of(const float4& profile); // of its four numbers
float least_of(const float4& profile);

// Are the waves that `params` asks for bends of the strands themselves, and not laid on when they are drawn? They are
// where eight nodes or more make a wave, and the solver knows bends.
bool waves_are_shape(const HairParams& params);
bool curls_are_shape(const HairParams& params); // the same of curls

bool has_clumps(const HairParams& params);

// Linear light for a component of an sRGB colour (IEC 61966-2-1).
float linear_of_srgb(float component);

// Radians for degrees, linear for sRGB (IEC 61966-2-1), unit length for directions, and the hair's colours from its
// pigment where look.pigment says so: what kernels and shaders read.
HairParams device_params(const HairParams& authored);

// The same declarations as a std140 block named `params`, since GLSL cannot read params.def itself.
std::string glsl_params_block();

} // namespace coif
