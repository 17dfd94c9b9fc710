#pragma once
#include <filesystem>
#include <string>

namespace coif
{

// The text of a kernel or shader with its `#include "..."` lines pasted in. coif does this itself, rather than pass -I,
// because GLSL has no include and vendors' caches of built kernels do not look into headers.
//
// A name is looked for in the including file's folder and then in `other`; each file is pasted once, but a .def every
// time. The name "params" stands for `params_text`. Throws Error for a file that is missing.
std::string load_source(const std::filesystem::path& file, const std::filesystem::path& other = {},
                        const std::string& params_text = {});

// Where coif's own kernels/, shaders/, hairstyles/ and assets/ lie: COIF_DATA if set, else beside the program's build
// folder, else where it was installed. Throws Error when none of them is there.
const std::filesystem::path& data_folder();

} // namespace coif
