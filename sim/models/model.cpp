#include "sim/models/model.h"

#include "sim/error.h"
#include "sim/models/all.h"

namespace coif::study
{

const std::vector<Model>& models()
{
    static const std::vector<Model> all = {
        {.name = "shake",
         .source = "Ryckaert, Ciccotti, Berendsen. Numerical integration of the cartesian equations of motion. 1977",
         .knob = "substeps",
         .knobs = {1, 2, 3, 4, 6, 8, 16, 32, 64},
         .bending = Bending::material,
         .holds_tip = true,
         .collides = true,
         .run = run_shake},
        {.name = "mass_spring_explicit",
         .source = "Rosenblum, Carlson, Tripp. Simulating the structure and dynamics of human hair. 1991",
         .knob = "substeps",
         .knobs = {16, 32, 64, 128, 256},
         .bending = Bending::material,
         .holds_tip = true,
         .collides = true,
         .run = run_mass_spring_explicit},
        {.name = "anjyo",
         .source = "Anjyo, Usami, Kurihara. A simple method for extracting the natural beauty of hair. 1992",
         .knob = "substeps",
         .knobs = {1, 2, 4, 8, 16},
         .bending = Bending::strength,
         .holds_tip = false,
         .collides = false,
         .run = run_anjyo},
        {.name = "mass_spring_implicit",
         .source = "Baraff, Witkin. Large steps in cloth simulation. 1998",
         .knob = "substeps",
         .knobs = {1, 2, 4, 8, 16, 32, 64},
         .bending = Bending::material,
         .holds_tip = true,
         .collides = true,
         .run = run_mass_spring_implicit},
        {.name = "articulated",
         .source = "Hadap, Magnenat-Thalmann. Modeling dynamic hair as a continuum. 2001",
         .knob = "substeps",
         .knobs = {1, 2, 4, 8, 16, 32, 64},
         .bending = Bending::material,
         .holds_tip = false,
         .collides = false,
         .run = run_articulated},
        {.name = "pbd",
         .source = "Mueller, Heidelberger, Hennix, Ratcliff. Position based dynamics. 2007; in the thesis' sweeps",
         .knob = "iterations",
         .knobs = {1, 2, 4, 8, 16, 32, 64, 128},
         .bending = Bending::strength,
         .holds_tip = true,
         .collides = true,
         .run = run_pbd},
        {.name = "pbd_over_relaxed",
         .source = "the same, over-relaxed: Young. Iterative methods for solving partial difference equations of "
                   "elliptic type. 1954",
         .knob = "iterations",
         .knobs = {4, 8, 16, 32, 64},
         .bending = Bending::strength,
         .holds_tip = true,
         .collides = true,
         .run = run_pbd_over_relaxed},
        {.name = "ftl",
         .source = "Mueller, Kim, Chentanez. Fast simulation of inextensible hair and fur. 2012",
         .knob = "substeps",
         .knobs = {1, 2, 4, 8, 16},
         .bending = Bending::none,
         .holds_tip = false,
         .collides = true,
         .run = run_ftl},
        {.name = "xpbd",
         .source =
             "Macklin, Storey, Lu, Terdiman, Chentanez, Jeschke, Mueller. Small steps in physics simulation. 2019",
         .knob = "substeps",
         .knobs = {2, 4, 8, 16, 32, 64, 128},
         .bending = Bending::material,
         .holds_tip = true,
         .collides = true,
         .run = run_xpbd},
    };
    return all;
}

const Model& model(const std::string& name)
{
    std::string names;
    for (const Model& each : models())
    {
        if (each.name == name)
            return each;
        names += (names.empty() ? "" : ", ") + std::string(each.name);
    }
    throw fail("there is no model '{}'; there are: {}", name, names);
}

} // namespace coif::study
