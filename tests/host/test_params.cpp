// The table of parameters (kernels/params.def) and what walks over it.
#include "sim/hairstyle.h"
#include "tests/host/entries.h"
#include "tests/host/scratch.h"

#include <cmath>
#include <cstring>
#include <numbers>
#include <set>

namespace coif
{
namespace
{

using test::between;
using test::error_of;

double linear_of_srgb(double c) // IEC 61966-2-1
{
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

// Another value than `style` has, in range.
void change(Hairstyle& style, const ParamInfo& info)
{
    std::mt19937 random(1);
    if (info.kind == Kind::LIST)
        test::add_entry(style, info, random);
    else if (info.kind == Kind::SHAPE)
        style.host.groom_rest.shapes = std::make_shared<const StrandShapes>();
    else if (info.kind == Kind::TEXT)
        assign(style, info.path() + "=something else");
    else
    {
        float now[kMostNumbers] = {};
        get_numbers(style.params, info, now);
        double wanted[kMostNumbers] = {now[0], now[1], now[2], now[3]};
        const int last = info.components() - 1; // the one that a slip in a count would forget
        wanted[last] = now[last] == info.max ? info.min : info.max;
        set_numbers(style.params, info, wanted);
    }
}

TEST(Params, every_path_is_unique_and_found)
{
    std::set<std::string> seen;
    for (const ParamInfo& info : param_table())
    {
        EXPECT_TRUE(seen.insert(info.path()).second) << info.path();
        EXPECT_EQ(find_param(info.path()), &info) << info.path();
    }
    EXPECT_GT(seen.size(), 50u);
    for (const char* unknown :
         {"", ".", "strand", "strand.", ".length", "strand.lengt", "strand.length ", "Strand.length"})
        EXPECT_EQ(find_param(unknown), nullptr) << unknown;
}

TEST(Params, a_group_stands_in_one_piece)
{
    std::set<std::string> done;
    std::string group;
    for (const ParamInfo& info : param_table())
        if (info.group != group)
        {
            group = info.group;
            EXPECT_TRUE(done.insert(group).second) << info.path();
        }
    EXPECT_STREQ(param_table()[0].group, "strand");
}

TEST(Params, what_one_choice_reads_is_read_under_it_alone)
{
    const auto read = [](const char* path, const std::vector<std::string>& sets)
    {
        Hairstyle style;
        for (const std::string& set : sets)
            assign(style, set);
        return is_read(*find_param(path), style.params);
    };
    EXPECT_TRUE(read("strand.length", {}));
    EXPECT_EQ(only_reader(*find_param("strand.length")), "");
    struct Reader
    {
        const char* path;
        std::vector<std::string> by, not_by;
        const char* said;
    };
    const Reader readers[] = {
        {"solver.iterations", {"solver.kind=pbd"}, {"solver.kind=direct"}, "solver.kind is pbd"},
        {"bending.droop", {"solver.kind=direct"}, {"solver.kind=pbd"}, "solver.kind is direct"},
        {"look.diffuse", {"look.level=kajiya_kay"}, {"look.level=auto"}, "look.level is kajiya_kay"},
        {"look.roughness", {"look.level=karis"}, {"look.level=kajiya_kay"}, "look.level is not kajiya_kay"},
        {"look.sky_radiance", {"look.level=auto"}, {"look.level=kajiya_kay"}, "look.level is not kajiya_kay"},
        {"look.tolerance", {"look.level=auto"}, {"look.level=dual_scattering"}, "look.level is auto"},
        {"look.eumelanin", {"look.pigment=melanin"}, {"look.pigment=color"}, "look.pigment is melanin"},
    };
    for (const Reader& reader : readers)
    {
        EXPECT_TRUE(read(reader.path, reader.by)) << reader.path;
        EXPECT_FALSE(read(reader.path, reader.not_by)) << reader.path;
        EXPECT_EQ(only_reader(*find_param(reader.path)), reader.said);
    }
    EXPECT_FALSE(read("look.azimuthal_roughness", {"look.level=kajiya_kay"}));
    EXPECT_TRUE(read("look.azimuthal_roughness", {"look.level=kajiya_kay", "look.pigment=melanin"}));
    EXPECT_TRUE(read("look.azimuthal_roughness", {"look.level=far_field"}));
    // Where colours tell something else they are lit as the thesis does it, whatever the level.
    EXPECT_TRUE(read("look.diffuse", {"look.level=auto", "render.colors=stretch"}));
    for (const ParamInfo& info : param_table())
        EXPECT_EQ(only_reader(info).empty(), info.read_by == ReadBy::ALL) << info.path();
}

TEST(Params, every_default_lies_in_its_range)
{
    const HairParams defaults;
    for (const ParamInfo& info : param_table())
    {
        if (info.on_host())
            continue;
        float v[kMostNumbers] = {};
        get_numbers(defaults, info, v);
        for (int i = 0; i < info.components(); ++i)
        {
            EXPECT_GE(v[i], info.min) << info.path();
            EXPECT_LE(v[i], info.max) << info.path();
        }
    }
}

TEST(Params, every_parameter_can_be_changed_or_has_but_one_label)
{
    for (const ParamInfo& info : param_table())
    {
        const bool one_label = info.kind == Kind::CHOICE && param_labels(info).size() == 1;
        EXPECT_EQ(info.min < info.max, !info.on_host() && !one_label) << info.path();
    }
}

TEST(Params, every_help_is_a_sentence)
{
    for (const ParamInfo& info : param_table())
    {
        const std::string help = info.help;
        ASSERT_GT(help.size(), 10u) << info.path();
        EXPECT_EQ(help.back(), '.') << info.path();
    }
}

TEST(Params, the_labels_of_a_choice_are_as_many_as_its_range)
{
    for (const ParamInfo& info : param_table())
    {
        if (info.kind != Kind::CHOICE)
        {
            EXPECT_STREQ(info.labels, "") << info.path();
            continue;
        }
        const std::vector<std::string> labels = param_labels(info);
        EXPECT_EQ(info.min, 0.0f) << info.path();
        EXPECT_EQ(size_t(info.max) + 1, labels.size()) << info.path();
        const std::set<std::string> unique(labels.begin(), labels.end());
        EXPECT_EQ(unique.size(), labels.size()) << info.path();
        EXPECT_FALSE(unique.contains("")) << info.path();
    }
    EXPECT_EQ(param_labels(*find_param("smoothing.curve")),
              (std::vector<std::string>{"linear", "cosine", "cubic", "catmull_rom"}));
}

TEST(Params, every_kind_scope_and_effect_has_a_name)
{
    for (const ParamInfo& info : param_table())
    {
        EXPECT_STRNE(kind_name(info.kind), "");
        EXPECT_STRNE(scope_name(info.scope), "");
        EXPECT_STRNE(effect_name(info.effect), "");
    }
    EXPECT_STREQ(kind_name(Kind::LIST), "list");
    EXPECT_STREQ(scope_name(Scope::PROFILE), "profile");
    EXPECT_STREQ(effect_name(Effect::REBUILD), "rebuild");
}

TEST(Params, the_nearest_name_is_what_a_slip_of_the_finger_meant)
{
    const std::pair<const char*, const char*> slips[] = {{"strand.lenght", "strand.length"},
                                                         {"strnd.length", "strand.length"},
                                                         {"length", "strand.length"},
                                                         {"hair.length", "strand.length"},
                                                         {"forces.stretching", "solver.stretching"},
                                                         {"look.root_colour", "look.root_color"},
                                                         {"light_direction", "look.light_direction"},
                                                         {"colliders", "collider"},
                                                         {"wave.binormal_frequncy", "wave.binormal_frequency"}};
    for (const auto& [slip, meant] : slips)
        EXPECT_EQ(nearest_param(slip), meant) << slip;
    for (const ParamInfo& info : param_table())
        EXPECT_EQ(nearest_param(info.path()), info.path());
    for (const std::string& odd :
         {std::string(), std::string("."), std::string(3 << 20, 'x'), std::string("\0\xff", 2)})
        EXPECT_NE(find_param(nearest_param(odd)), nullptr);
}

TEST(Params, a_number_out_of_range_is_told_with_range_and_unit)
{
    const auto told = [](const char* path, double x, double y = 0.0, double z = 0.0)
    {
        HairParams params;
        const double values[kMostNumbers] = {x, y, z};
        const std::string text = error_of([&] { set_numbers(params, *find_param(path), values); });
        EXPECT_EQ(params.strand_length, text == "no error" ? float(x) : HairParams{}.strand_length);
        return text;
    };
    EXPECT_EQ(told("strand.length", -1), "strand.length is -1, but must lie in [0.002, 1.5] m");
    EXPECT_EQ(told("strand.nodes", 2), "strand.nodes is 2, but must lie in [3, 64]");
    EXPECT_EQ(told("solver.rate", 29.5), "solver.rate is 29.5, but must lie in [30, 240] Hz");
    EXPECT_EQ(told("forces.wind", 0, 0, 100.5), "forces.wind is 100.5, but must lie in [-100, 100] m/s^2");
    EXPECT_EQ(told("look.tip_color", 0, 1.5, 0), "look.tip_color is 1.5, but must lie in [0, 1]");
    EXPECT_EQ(told("smoothing.curve", 4), "smoothing.curve is 4, but must lie in [0, 3]");
    EXPECT_EQ(told("strand.length", NAN), "strand.length is nan, but must be a finite number");
    EXPECT_EQ(told("head.offset", 0, 0, -INFINITY), "head.offset is -inf, but must be a finite number");
    EXPECT_EQ(told("strand.length", INFINITY), "strand.length is inf, but must be a finite number");
    EXPECT_EQ(told("strand.length", 0.2), "no error");
}

TEST(Params, a_refused_vector_leaves_no_part_of_itself)
{
    HairParams params;
    const double values[kMostNumbers] = {1.0, 2.0, 1000.0};
    EXPECT_NE(error_of([&] { set_numbers(params, *find_param("forces.wind"), values); }), "no error");
    EXPECT_EQ(params.forces_wind, HairParams{}.forces_wind);
}

TEST(Params, both_ends_of_every_range_are_taken_and_read_back)
{
    for (const ParamInfo& info : param_table())
        for (const float end : {info.min, info.max})
        {
            if (info.on_host())
                continue;
            HairParams params;
            const double values[kMostNumbers] = {end, end, end, end};
            set_numbers(params, info, values);
            float v[kMostNumbers] = {};
            get_numbers(params, info, v);
            for (int i = 0; i < info.components(); ++i)
                EXPECT_EQ(v[i], end) << info.path();
        }
}

TEST(Params, the_device_reads_radians_and_linear_colours_and_all_else_as_authored)
{
    std::mt19937 random(7);
    for (int trial = 0; trial < 50; ++trial)
    {
        HairParams authored;
        for (const ParamInfo& info : param_table())
            if (!info.on_host())
            {
                double v[kMostNumbers];
                for (double& x : v)
                    x = info.kind == Kind::INT || info.kind == Kind::CHOICE
                            ? std::floor(between(random, info.min, info.max))
                            : between(random, info.min, info.max);
                set_numbers(authored, info, v);
            }
        const HairParams device = device_params(authored);
        for (const ParamInfo& info : param_table())
        {
            if (info.on_host() || info.path() == "look.light_direction")
                continue;
            float a[kMostNumbers], d[kMostNumbers];
            get_numbers(authored, info, a);
            get_numbers(device, info, d);
            for (int i = 0; i < info.components(); ++i)
                if (info.kind == Kind::COLOR)
                    EXPECT_NEAR(d[i], linear_of_srgb(a[i]), 1e-6) << info.path() << " of " << a[i];
                else if (info.unit == std::string("deg"))
                    EXPECT_NEAR(d[i], a[i] * std::numbers::pi / 180.0, 1e-6 * std::abs(d[i])) << info.path();
                else // waves that the strands take as their shape are not laid on once more
                    EXPECT_EQ(d[i], (waves_are_shape(authored) && info.path().ends_with("_amplitude")) ||
                                            (curls_are_shape(authored) && info.path() == "curl.radius")
                                        ? 0.0f
                                        : a[i])
                        << info.path();
        }
        const float4 l = device.look_light_direction, from = authored.look_light_direction;
        const double norm = std::hypot(double(from.x), double(from.y), double(from.z));
        EXPECT_NEAR(l.x, from.x / norm, 1e-6);
        EXPECT_NEAR(l.y, from.y / norm, 1e-6);
        EXPECT_NEAR(l.z, from.z / norm, 1e-6);
    }
}

TEST(Params, srgb_is_exact_at_black_white_and_the_knee)
{
    for (const double c : {0.0, 0.04, 0.04045, 0.0405, 0.2, 0.5, 1.0})
    {
        HairParams params;
        params.look_tip_color = F4(float(c), float(c), float(c), 1.0f);
        EXPECT_NEAR(device_params(params).look_tip_color.y, linear_of_srgb(c), 2e-7) << c;
    }
}

TEST(Params, a_light_without_direction_shines_from_above)
{
    HairParams params;
    for (const float4 none : {F4(0, 0, 0, 0), F4(1e-20f, 0, -1e-30f, 0)})
    {
        params.look_light_direction = none;
        EXPECT_EQ(device_params(params).look_light_direction, F4(0, 1, 0, 0));
    }
    params.look_light_direction = F4(0, 0, -1e-3f, 0);
    EXPECT_EQ(device_params(params).look_light_direction, F4(0, 0, -1, 0));
}

TEST(Params, the_shaders_block_names_each_device_parameter_once_and_in_order)
{
    std::istringstream block(glsl_params_block());
    std::string line;
    std::getline(block, line);
    EXPECT_EQ(line, "layout(std140) uniform HairParams {");
    for (const ParamInfo& info : param_table())
    {
        if (info.on_host())
            continue;
        ASSERT_TRUE(std::getline(block, line));
        std::istringstream words(line);
        std::string type, name, more;
        words >> type >> name;
        EXPECT_FALSE(words >> more);
        EXPECT_EQ(name, std::string(info.group) + "_" + info.name + ";");
        EXPECT_EQ(type, info.components() > 1                                 ? "vec4"
                        : info.kind == Kind::INT || info.kind == Kind::CHOICE ? "int"
                                                                              : "float");
    }
    std::getline(block, line);
    EXPECT_EQ(line, "} params;");
    EXPECT_FALSE(std::getline(block, line));
}

TEST(Params, a_changed_value_is_seen_and_copied_and_nothing_else_is)
{
    for (const ParamInfo& info : param_table())
    {
        Hairstyle changed;
        change(changed, info);
        const bool one_label = info.kind == Kind::CHOICE && param_labels(info).size() == 1;
        EXPECT_EQ(same_value(changed, Hairstyle{}, info), one_label) << info.path();
        Hairstyle copy;
        copy_value(changed, copy, info);
        for (const ParamInfo& other : param_table())
        {
            EXPECT_TRUE(same_value(copy, changed, other)) << info.path() << " and " << other.path();
            EXPECT_TRUE(&other == &info || same_value(copy, Hairstyle{}, other)) << info.path() << ", " << other.path();
        }
    }
}

} // namespace
} // namespace coif
