// The structs of kernels/shared.h as three compilers lay them out: C++, OpenCL C and GLSL.
#include "app/gl.h"
#include "sim/error.h"
#include "sim/hairstyle.h"
#include "sim/source.h"
#include "tests/on_device.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <regex>

namespace coif
{
namespace
{

namespace fs = std::filesystem;

struct Field
{
    std::string type, name; // of the struct's typedef, of the member
    int offset;             // that C++ gives it; -1 asks for the struct's size
};

// Formatted by hand: clang-format never comes to rest on these lines.
// clang-format off
#define STEP_FIELDS(X)                                                                                                 \
    X(head_row0) X(head_row1) X(head_row2) X(turn_row0) X(turn_row1) X(turn_row2) X(origin_move) X(head_velocity)      \
    X(head_center) X(wind) X(gust_origin) X(body_corner) X(grid_corner) X(sweep) X(light_box) X(push_box)       \
    X(substep) X(drag_keep) X(drag_gain)                                                                               \
    X(gravity) X(stretch) X(relax) X(bend) X(clearance) X(parting) X(repulsion) X(bend_droop) X(bend_modulus)          \
    X(bend_most) X(turning_rate) X(tip_mass) X(acceleration) X(push_out) X(guides) X(drawn_multi) X(drawn)             \
    X(colliders) X(head_colliders) X(teleport) X(last_substep) X(body_density) X(density_stride) X(density_unit)       \
    X(sweep_axis) X(sweep_from) X(sweep_sign) X(body_x) X(body_y) X(body_z)
#define PATH_FIELDS(X) X(row) X(drag)
#define CAPSULE_FIELDS(X) X(center) X(axis)
#define LOOK_FIELDS(X) X(root_color) X(tip_color) X(wave) X(own)
#define DRAWN_FIELDS(X) X(root) X(weights) X(guide0) X(guide1) X(guide2) X(seed) X(leader)
#define TIED_FIELDS(X) X(place) X(ring) X(tail) X(unused0) X(unused1)
#define TAIL_FIELDS(X)                                                                                                 \
    X(axis) X(side) X(depth) X(plait) X(bound) X(length) X(ring) X(radius) X(fullest) X(together) X(guide) X(unused0)  \
    X(unused1) X(unused2)
// clang-format on

std::vector<Field> fields_of_params()
{
    std::vector<Field> fields;
    for (const ParamInfo& info : param_table())
        if (!info.on_host())
            fields.push_back({"HairParams", std::string(info.group) + "_" + info.name, int(info.offset)});
    return fields;
}

std::vector<Field> all_fields()
{
    std::vector<Field> fields = fields_of_params();
#define STEP_FIELD(name) fields.push_back({"StepInfo", #name, int(offsetof(StepInfo, name))});
#define DRAWN_FIELD(name) fields.push_back({"DrawnStrand", #name, int(offsetof(DrawnStrand, name))});
#define PATH_FIELD(name) fields.push_back({"StepPath", #name, int(offsetof(StepPath, name))});
#define CAPSULE_FIELD(name) fields.push_back({"Capsule", #name, int(offsetof(Capsule, name))});
#define TIED_FIELD(name) fields.push_back({"TiedStrand", #name, int(offsetof(TiedStrand, name))});
#define TAIL_FIELD(name) fields.push_back({"Tail", #name, int(offsetof(Tail, name))});
#define LOOK_FIELD(name) fields.push_back({"StrandLook", #name, int(offsetof(StrandLook, name))});
    STEP_FIELDS(STEP_FIELD)
    PATH_FIELDS(PATH_FIELD)
    DRAWN_FIELDS(DRAWN_FIELD)
    CAPSULE_FIELDS(CAPSULE_FIELD)
    TIED_FIELDS(TIED_FIELD)
    TAIL_FIELDS(TAIL_FIELD)
    LOOK_FIELDS(LOOK_FIELD)
    return fields;
}

// Members of a struct as they stand in the header, in order, arrays without their sizes.
std::vector<std::string> members_in_text(const std::string& text, const std::string& type)
{
    const size_t begin = text.find("typedef struct " + type), end = text.find("} " + type, begin);
    const std::string body = std::regex_replace(text.substr(begin, end - begin), std::regex("//[^\n]*"), "");
    const std::regex declaration("(float4|float|int)\\s+([^;]*);"), name("\\w+"), size("\\[[^\\]]*\\]");
    std::vector<std::string> names;
    for (std::sregex_iterator d(body.begin(), body.end(), declaration), none; d != none; ++d)
    {
        const std::string list = std::regex_replace((*d)[2].str(), size, "");
        for (std::sregex_iterator n(list.begin(), list.end(), name); n != none; ++n)
            names.push_back(n->str());
    }
    return names;
}

TEST(Layout, TheTestKnowsEveryFieldOfTheStructs)
{
    const std::string text = read_file(data_folder() / "kernels" / "shared.h");
    for (const std::string type : {"StepInfo", "StepPath", "DrawnStrand", "Capsule", "TiedStrand", "Tail"})
    {
        std::vector<std::string> known;
        for (const Field& field : all_fields())
            if (field.type == type)
                known.push_back(field.name);
        EXPECT_EQ(known, members_in_text(text, type));
    }
}

TEST(Layout, OpenClPlacesEveryFieldWhereCppDoes)
{
    const std::vector<Field> fields = all_fields();
    std::string body;
    for (size_t i = 0; i < fields.size(); ++i)
        body += fmt::format("    offset[{}] = (int)((char*)&{}.{} - (char*)&{});\n", i, fields[i].type + "_",
                            fields[i].name, fields[i].type + "_");
    int at = int(fields.size());
    for (const char* type :
         {"HairParams", "StepInfo", "StepPath", "DrawnStrand", "Capsule", "TiedStrand", "Tail", "StrandLook"})
        body += fmt::format("    offset[{}] = (int)sizeof({});\n", at++, type);

    // A kernel is read with its headers beside it.
    const fs::path folder = fs::path(COIF_BUILD_FOLDER) / "layout_kernels";
    fs::remove_all(folder);
    fs::create_directories(folder);
    for (const char* header : {"shared.h", "params.def"})
        fs::copy_file(data_folder() / "kernels" / header, folder / header);
    write_file(folder / "report_layout.cl", "#include \"shared.h\"\nkernel void report_layout(global int* offset)\n{\n"
                                            "    HairParams HairParams_;\n    StepInfo StepInfo_;\n"
                                            "    StepPath StepPath_;\n    DrawnStrand DrawnStrand_;\n"
                                            "    Capsule Capsule_;\n    TiedStrand TiedStrand_;\n    Tail Tail_;\n"
                                            "    StrandLook StrandLook_;\n" +
                                                body + "}\n");
    Device device = test_device();
    device.kernel_folder = folder;
    Kernel kernel = load_kernel(device, "report_layout", "");
    const Buffers buffers = {{"offset", filled(device, std::vector<int>(fields.size() + 8, -1))}};
    run(device, kernel, buffers, cl::NDRange(1));
    const std::vector<int> offset = read<int>(device, buffers.at("offset"), fields.size() + 8);

    for (size_t i = 0; i < fields.size(); ++i)
        EXPECT_EQ(offset[i], fields[i].offset) << fields[i].type << "." << fields[i].name;
    EXPECT_EQ(offset[fields.size()], int(sizeof(HairParams)));
    EXPECT_EQ(offset[fields.size() + 1], int(sizeof(StepInfo)));
    EXPECT_EQ(offset[fields.size() + 2], int(sizeof(StepPath)));
    EXPECT_EQ(offset[fields.size() + 3], int(sizeof(DrawnStrand)));
    EXPECT_EQ(offset[fields.size() + 4], int(sizeof(Capsule)));
    EXPECT_EQ(offset[fields.size() + 5], int(sizeof(TiedStrand)));
    EXPECT_EQ(offset[fields.size() + 6], int(sizeof(Tail)));
    EXPECT_EQ(offset[fields.size() + 7], int(sizeof(StrandLook)));
}

// A program whose only purpose is to make a uniform block active.
class BlockProgram
{
  public:
    BlockProgram(const std::string& declarations, const std::string& value)
    {
        id_ = glCreateProgram();
        attach(GL_VERTEX_SHADER, "#version 150\nvoid main() { gl_Position = vec4(0.0); }\n");
        attach(GL_FRAGMENT_SHADER,
               "#version 150\n" + declarations + "out vec4 color;\nvoid main() { color = vec4(" + value + "); }\n");
        glLinkProgram(id_);
        GLint linked = 0;
        glGetProgramiv(id_, GL_LINK_STATUS, &linked);
        EXPECT_TRUE(linked);
    }
    ~BlockProgram() { glDeleteProgram(id_); }
    BlockProgram(const BlockProgram&) = delete;

    GLint offset(const std::string& member) const
    {
        const char* name = member.c_str();
        GLuint index = GL_INVALID_INDEX;
        glGetUniformIndices(id_, 1, &name, &index);
        GLint value = -1;
        if (index != GL_INVALID_INDEX)
            glGetActiveUniformsiv(id_, 1, &index, GL_UNIFORM_OFFSET, &value);
        return value;
    }
    GLint bytes(const char* block) const
    {
        GLint value = -1;
        glGetActiveUniformBlockiv(id_, glGetUniformBlockIndex(id_, block), GL_UNIFORM_BLOCK_DATA_SIZE, &value);
        return value;
    }

  private:
    void attach(GLenum stage, const std::string& text)
    {
        const char* source = text.c_str();
        const GLuint shader = glCreateShader(stage);
        glShaderSource(shader, 1, &source, nullptr);
        glCompileShader(shader);
        char log[1024] = {};
        glGetShaderInfoLog(shader, sizeof log - 1, nullptr, log);
        EXPECT_STREQ(log, "");
        glAttachShader(id_, shader);
        glDeleteShader(shader);
    }
    GLuint id_ = 0;
};

TEST(Layout, GlslPlacesEveryParameterWhereCppDoes)
{
    const Window window(16, 16, Window::HIDDEN);
    const BlockProgram program(glsl_params_block(), "params.strand_spacing");
    for (const Field& field : fields_of_params())
        EXPECT_EQ(program.offset("HairParams." + field.name), field.offset) << field.name;
    EXPECT_EQ(program.bytes("HairParams"), int(sizeof(HairParams)));
}

TEST(Layout, GlslPlacesTheFramesFieldsAsTheRendererFillsThem)
{
    // FrameBlock of app/renderer.cpp: a matrix, six float4 and four whole numbers without gaps.
    const Window window(16, 16, Window::HIDDEN);
    const BlockProgram program(load_source(data_folder() / "shaders" / "frame.glsl"), "frame.sweep.x");
    const char* const names[] = {"view_projection", "camera_position", "head_row0", "head_row1",
                                 "head_row2",       "grid_corner",     "sweep",     "slices"};
    int offset = 0;
    for (const char* name : names)
    {
        EXPECT_EQ(program.offset(std::string("Frame.") + name), offset) << name;
        offset += offset == 0 ? 64 : 16;
    }
    EXPECT_EQ(program.bytes("Frame"), offset);
}

} // namespace
} // namespace coif
