#pragma once
#include <string>

namespace coif
{

// One line on the terminal that each call writes over, "bob (3 of 10)"; empty: takes it away. Nothing where words go to
// a file.
void show_progress(const std::string& doing);

} // namespace coif
