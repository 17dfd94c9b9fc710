#include "sim/models/model.h"

#include "sim/error.h"
#include "sim/models/all.h"

namespace coif::study
{

const std::vector<Model>& models()
{
    static const std::vector<Model> all = {
        {"shake",
         "Ryckaert, Ciccotti, Berendsen. Numerical integration of the cartesian equations of motion. 1977",
         "substeps",
         {1, 2, 3, 4, 6, 8, 16, 32, 64},
         Bending::material,
         true,
         true,
         run_shake},
        {"mass_spring_explicit",
         "Rosenblum, Carlson, Tripp. Simulating the structure and dynamics of human hair. 1991",
         "substeps",
         {16, 32, 64, 128, 256},
         Bending::material,
         true,
         true,
         run_mass_spring_explicit},
        {"anjyo",
         "Anjyo, Usami, Kurihara. A simple method for extracting the natural beauty of hair. 1992",
         "substeps",
         {1, 2, 4, 8, 16},
         Bending::strength,
         false,
         false,
         run_anjyo},
        {"mass_spring_implicit",
         "Baraff, Witkin. Large steps in cloth simulation. 1998",
         "substeps",
         {1, 2, 4, 8, 16, 32, 64},
         Bending::material,
         true,
         true,
         run_mass_spring_implicit},
        {"articulated",
         "Hadap, Magnenat-Thalmann. Modeling dynamic hair as a continuum. 2001",
         "substeps",
         {1, 2, 4, 8, 16, 32, 64},
         Bending::material,
         false,
         false,
         run_articulated},
        {"pbd",
         "Mueller, Heidelberger, Hennix, Ratcliff. Position based dynamics. 2007; in the thesis' sweeps",
         "iterations",
         {1, 2, 4, 8, 16, 32, 64, 128},
         Bending::strength,
         true,
         true,
         run_pbd},
        {"pbd_over_relaxed",
         "the same, over-relaxed: Young. Iterative methods for solving partial difference equations"
         " of elliptic type. 1954",
         "iterations",
         {4, 8, 16, 32, 64},
         Bending::strength,
         true,
         true,
         run_pbd_over_relaxed},
        {"ftl",
         "Mueller, Kim, Chentanez. Fast simulation of inextensible hair and fur. 2012",
         "substeps",
         {1, 2, 4, 8, 16},
         Bending::none,
         false,
         true,
         run_ftl},
        {"xpbd",
         "Macklin, Storey, Lu, Terdiman, Chentanez, Jeschke, Mueller. Small steps in physics simulation. 2019",
         "substeps",
         {2, 4, 8, 16, 32, 64, 128},
         Bending::material,
         true,
         true,
         run_xpbd},
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
