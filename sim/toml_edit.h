#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace coif
{

// Saving over an author's TOML file: only what changed is rewritten, at the source positions that toml++ gives, so that
// comments, order, spacing, line endings and a byte order mark stay as they are. A value counts as changed when it
// parses to something else: 0.20 stays when 0.2 is wanted, and so does 1 when 1.0 is, for a reader takes both.
//
// Every result is parsed again. If it does not say what was asked for, or says anything else that the file did not say
// before, toml++'s formatter writes the file afresh: the comments are lost then, the values are not.

// A wanted value: {"strand", "length", "0.2"}, as TOML text; without a value the key is removed. A group is a dotted
// path of plain names ("solver.grid"), or empty for the top of the file. A missing group is made.
struct TomlEdit
{
    std::string group, key;
    std::optional<std::string> value;
};

// One entry of an array of tables: keys and the TOML text of their values.
using TomlEntry = std::vector<std::pair<std::string, std::string>>;

// `text` with the edits made in turn. A removed key takes its line along and leaves the comments above it.
// Throws Error if `text` or a value is no TOML, or if a group's name belongs to something that is not a table.
std::string edit_toml(const std::string& text, const std::vector<TomlEdit>& edits);

// `text` with the array of tables [[name]] made equal to `entries`. Entry i patches the i-th one there is, surplus ones
// go with their lines, further ones follow the last [[name]], or the end of the file. Without entries no [[name]] is
// left. An array written inline, name = [{...}, ...], is rewritten as a whole where it differs. Throws as above.
std::string edit_toml_array(const std::string& text, const std::string& name, const std::vector<TomlEntry>& entries);

} // namespace coif
