#include "sim/toml_edit.h"

#include "sim/error.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
#include <sstream>

namespace coif
{
namespace
{

// Bytes [begin, end) of a document's text.
struct Span
{
    size_t begin, end;
};

struct Document
{
    std::string text;
    toml::table root;
    std::vector<size_t> line_begins; // the first line begins after the byte order mark
};

// Where a key belongs: in the table that `path` leads to, or in one entry of the array of tables that it leads to.
struct Place
{
    std::vector<std::string> path;
    std::optional<size_t> entry;
    std::string key;
};

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

Document parse(const std::string& text)
{
    Document doc{text, {}, {text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0}};
    try
    {
        doc.root = toml::parse(text);
    }
    catch (const toml::parse_error& error)
    {
        const auto at = error.source().begin;
        throw fail("{}:{}: {}", at.line, at.column, error.description());
    }
    for (size_t i = 0; i < text.size(); ++i)
        if (text[i] == '\n')
            doc.line_begins.push_back(i + 1);
    return doc;
}

// ---- Positions ----

// toml++ counts lines and columns from 1; a column is a code point (a tab and a CR are one each, the mark is none).
size_t offset(const Document& doc, toml::source_position position)
{
    size_t at = doc.line_begins.at(position.line - 1);
    for (auto column = position.column; column > 1 && at < doc.text.size(); --column)
        do
            ++at;
        while (at < doc.text.size() && (static_cast<unsigned char>(doc.text[at]) & 0xC0) == 0x80);
    return at;
}

Span span(const Document& doc, const toml::node& node)
{
    return {offset(doc, node.source().begin), offset(doc, node.source().end)};
}

size_t key_begin(const Document& doc, const toml::key& key) { return offset(doc, key.source().begin); }

size_t line_begin(const Document& doc, size_t at)
{
    return *std::prev(std::upper_bound(doc.line_begins.begin() + 1, doc.line_begins.end(), at));
}

// One past the newline of the line that holds `at`.
size_t line_end(const Document& doc, size_t at)
{
    const size_t newline = doc.text.find('\n', at);
    return newline == std::string::npos ? doc.text.size() : newline + 1;
}

size_t skip_blanks(const std::string& text, size_t at)
{
    return std::min(text.find_first_not_of(" \t", at), text.size());
}

// ---- How a node is written: as a value, by headers, or by dotted keys ----

bool is_header_array(const toml::node& node)
{
    const auto* array = node.as_array();
    return array && !array->empty() && array->front().is_table() && !array->front().as_table()->is_inline();
}

bool is_value(const toml::node& node)
{
    return node.is_table() ? node.as_table()->is_inline() : !is_header_array(node);
}

// toml++ gives a table made by a header on the way to another ([a.b] makes a) the position of that header.
bool made_by_header(const Document& doc, const toml::table& table)
{
    return !table.is_inline() && &table != &doc.root && doc.text[offset(doc, table.source().begin)] == '[';
}

bool shares_begin(const toml::table& table, toml::source_position begin)
{
    for (auto&& [key, child] : table)
        if (!is_value(child) &&
            (child.source().begin == begin || (child.is_table() && shares_begin(*child.as_table(), begin))))
            return true;
    return false;
}

bool has_own_header(const Document& doc, const toml::table& table)
{
    return made_by_header(doc, table) && !shares_begin(table, table.source().begin);
}

// The last line that gives a key of `table`, itself or by dots, and where on it the table's own keys begin.
struct Statement
{
    size_t key, end;
};

std::optional<Statement> last_statement(const Document& doc, const toml::table& table)
{
    std::optional<Statement> last;
    for (auto&& [key, child] : table)
    {
        std::optional<Statement> statement;
        if (is_value(child))
            statement = {key_begin(doc, key), line_end(doc, span(doc, child).end)};
        else if (child.is_table() && !made_by_header(doc, *child.as_table()))
        {
            statement = last_statement(doc, *child.as_table());
            if (statement)
                statement->key = key_begin(doc, key);
        }
        if (statement && (!last || statement->end > last->end))
            last = statement;
    }
    return last;
}

// ---- Comparing ----

bool holds_nothing(const toml::node& node)
{
    const auto* table = node.as_table();
    return table && std::all_of(table->begin(), table->end(), [](auto&& item) { return holds_nothing(item.second); });
}

bool same(const toml::node& a, const toml::node& b);

// A group without keys says as much as none.
bool says_all_of(const toml::table& a, const toml::table& b)
{
    for (auto&& [key, value] : b)
        if (!holds_nothing(value) && !(a.contains(key.str()) && same(*a.get(key.str()), value)))
            return false;
    return true;
}

bool same(const toml::node& a, const toml::node& b)
{
    if (a.is_number() && b.is_number() && a.type() != b.type())
        return *a.value<double>() == *b.value<double>();
    if (a.type() != b.type())
        return false;
    if (a.is_table())
        return says_all_of(*a.as_table(), *b.as_table()) && says_all_of(*b.as_table(), *a.as_table());
    if (a.is_array())
        return std::equal(a.as_array()->begin(), a.as_array()->end(), b.as_array()->begin(), b.as_array()->end(), same);
    if (a.is_floating_point() && std::isnan(**a.as_floating_point()))
        return std::isnan(**b.as_floating_point());
    return a.visit(
        [&b](const auto& value)
        {
            if constexpr (toml::is_value<decltype(value)>)
                return value == *b.as<std::remove_cvref_t<decltype(value)>>();
            else
                return false;
        });
}

// ---- Places ----

std::vector<std::string> split(const std::string& group)
{
    std::vector<std::string> names;
    std::istringstream stream(group);
    for (std::string name; std::getline(stream, name, '.');)
        names.push_back(name);
    return names;
}

std::string key_text(const std::string& name)
{
    const auto bare = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
    if (!name.empty() && std::all_of(name.begin(), name.end(), bare))
        return name;
    std::string text = "\"";
    for (const char c : name)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F)
            text += fmt::format("\\u{:04X}", static_cast<int>(c));
        else
            text += (c == '"' || c == '\\' ? "\\" : "") + std::string(1, c);
    return text + "\"";
}

std::string dotted(const std::vector<std::string>& path, size_t first = 0)
{
    std::string text;
    for (size_t i = first; i < path.size(); ++i)
        text += (text.empty() ? "" : ".") + key_text(path[i]);
    return text;
}

// As far as `path` leads at present, and the innermost inline table on the way, after which names are only dotted.
struct Reach
{
    const toml::table* table;
    size_t depth; // names of the path used up
    const toml::table* inline_table = nullptr;
    size_t inline_depth = 0;
};

Reach reach(const Document& doc, const Place& place)
{
    Reach reached{&doc.root, 0};
    for (const auto& name : place.path)
    {
        const toml::node* child = reached.table->get(name);
        if (!child)
            break;
        ++reached.depth;
        if (place.entry && reached.depth == place.path.size() && is_header_array(*child))
            child = child->as_array()->get(*place.entry);
        if (!child->is_table())
            throw fail("{} is no table, so that {} cannot be written into it", name, place.key);
        reached.table = child->as_table();
        if (reached.table->is_inline())
            reached.inline_table = reached.table, reached.inline_depth = reached.depth;
    }
    return reached;
}

const toml::node* find(const Document& doc, const Place& place)
{
    const Reach reached = reach(doc, place);
    return reached.depth == place.path.size() ? reached.table->get(place.key) : nullptr;
}

// ---- Inserting ----

// The text with `inserted` in the place of `old`, in the line endings of the lines before.
std::string splice(const Document& doc, Span old, const std::string& inserted)
{
    size_t newline = old.begin > 0 ? doc.text.rfind('\n', old.begin - 1) : std::string::npos;
    if (newline == std::string::npos)
        newline = doc.text.find('\n');
    const bool crlf = newline != std::string::npos && newline > 0 && doc.text[newline - 1] == '\r';
    std::string text = doc.text.substr(0, old.begin);
    for (const char c : inserted)
    {
        if (c == '\n' && crlf && !text.ends_with('\r'))
            text += '\r';
        text += c;
    }
    return text + doc.text.substr(old.end);
}

std::string insert_lines(const Document& doc, size_t at, const std::string& lines)
{
    const bool on_new_line = at == doc.line_begins[0] || doc.text[at - 1] == '\n';
    return splice(doc, {at, at}, on_new_line ? lines : "\n" + lines);
}

// Whether a blank line is wanted to set off what is added at `at`.
bool follows_text(const Document& doc, size_t at)
{
    if (at <= doc.line_begins[0])
        return false;
    const size_t begin = line_begin(doc, at - 1);
    return doc.text.find_first_not_of(" \t\r\n", begin) < at;
}

std::string append_section(const Document& doc, size_t at, const std::string& section)
{
    return insert_lines(doc, at, (follows_text(doc, at) ? "\n" : "") + section);
}

// The file has no top-level key yet: before the first header and the comments that stand on it.
std::string insert_at_top(const Document& doc, const std::string& line)
{
    const auto starts_with = [&doc](size_t i, char c)
    {
        const size_t at = skip_blanks(doc.text, doc.line_begins[i]);
        return at < doc.text.size() && doc.text[at] == c;
    };
    size_t i = 0;
    while (i < doc.line_begins.size() && !starts_with(i, '['))
        ++i;
    if (i == doc.line_begins.size())
        return insert_lines(doc, doc.text.size(), line);
    while (i > 0 && starts_with(i - 1, '#'))
        --i;
    return insert_lines(doc, doc.line_begins[i], line + "\n");
}

std::string insert_inline(const Document& doc, const toml::table& table, const std::string& assignment)
{
    const size_t brace = span(doc, table).end - 1;
    const size_t last = doc.text.find_last_not_of(" \t", brace - 1);
    if (doc.text[last] == '{')
        return splice(doc, {last + 1, brace}, " " + assignment + " ");
    return splice(doc, {last + 1, last + 1}, ", " + assignment);
}

std::string insert_key(const Document& doc, const Place& place, const std::string& value)
{
    const Reach reached = reach(doc, place);
    const std::string assignment = key_text(place.key) + " = " + value;
    if (reached.inline_table)
    {
        const std::string path = dotted(place.path, reached.inline_depth);
        return insert_inline(doc, *reached.inline_table, path.empty() ? assignment : path + "." + assignment);
    }
    const std::string line = assignment + "\n";
    if (reached.depth == place.path.size())
    {
        if (const auto last = last_statement(doc, *reached.table))
        {
            // What stands before the key on its line is the indentation and the dotted path.
            const size_t begin = line_begin(doc, last->key);
            return insert_lines(doc, last->end, doc.text.substr(begin, last->key - begin) + line);
        }
        if (has_own_header(doc, *reached.table))
        {
            const size_t header = span(doc, *reached.table).begin, begin = line_begin(doc, header);
            return insert_lines(doc, line_end(doc, header), doc.text.substr(begin, header - begin) + line);
        }
    }
    if (place.path.empty())
        return insert_at_top(doc, line);
    return append_section(doc, doc.text.size(), "[" + dotted(place.path) + "]\n" + line);
}

// ---- Removing ----

// All values in and below a node, in the order of the text.
void collect_values(const Document& doc, const toml::node& node, std::vector<Span>& values)
{
    if (is_value(node))
        values.push_back(span(doc, node));
    else if (node.is_table())
        for (auto&& [key, child] : *node.as_table())
            collect_values(doc, child, values);
    std::sort(values.begin(), values.end(), [](Span a, Span b) { return a.begin < b.begin; });
}

std::string remove_inline(const Document& doc, const toml::table& table, const toml::node& node)
{
    std::vector<Span> items, gone;
    for (auto&& [key, child] : table)
        collect_values(doc, child, items);
    collect_values(doc, node, gone);
    const size_t open = span(doc, table).begin;
    std::string text = doc.text;
    for (size_t i = items.size(); i-- > 0;)
    {
        if (std::none_of(gone.begin(), gone.end(), [&](Span value) { return value.begin == items[i].begin; }))
            continue;
        const size_t after = skip_blanks(text, items[i].end);
        size_t begin = open + 1, end = after;
        if (i > 0)
            begin = items[i - 1].end, end = items[i].end;
        else if (text[after] == ',')
            begin = skip_blanks(text, open + 1), end = skip_blanks(text, after + 1);
        text.erase(begin, end - begin);
    }
    return text;
}

// The lines of a node whose key stands at `key`: a value's own, or sections, each from the header to the last key.
void collect_lines(const Document& doc, size_t key, const toml::node& node, std::vector<Span>& lines)
{
    if (is_value(node))
        lines.push_back({line_begin(doc, key), line_end(doc, span(doc, node).end)});
    else if (const auto* array = node.as_array())
        for (const auto& entry : *array)
            collect_lines(doc, 0, entry, lines);
    else
    {
        const toml::table& table = *node.as_table();
        const size_t header = span(doc, table).begin;
        const auto last = last_statement(doc, table);
        if (has_own_header(doc, table))
            lines.push_back({line_begin(doc, header), last ? last->end : line_end(doc, header)});
        for (auto&& [name, child] : table)
            collect_lines(doc, key_begin(doc, name), child, lines);
    }
}

std::string remove_lines(const Document& doc, std::vector<Span> lines)
{
    std::sort(lines.begin(), lines.end(), [](Span a, Span b) { return a.begin < b.begin; });
    std::string text;
    size_t kept = 0;
    for (const Span& gone : lines)
    {
        if (gone.begin > kept)
            text += doc.text.substr(kept, gone.begin - kept);
        kept = std::max(kept, gone.end);
    }
    return text + doc.text.substr(kept);
}

std::string remove_key(const Document& doc, const Place& place)
{
    const Reach reached = reach(doc, place);
    const toml::node& node = *reached.table->get(place.key);
    if (reached.inline_table)
        return remove_inline(doc, *reached.inline_table, node);
    std::vector<Span> lines;
    collect_lines(doc, key_begin(doc, reached.table->find(place.key)->first), node, lines);
    return remove_lines(doc, lines);
}

// ---- Setting ----

// A value's text without what surrounds it, and what it means.
struct Value
{
    std::string text;
    toml::table holder; // has it under "v"

    const toml::node& node() const { return *holder.get("v"); }
};

Value parse_value(const std::string& text)
{
    try
    {
        const Document doc = parse("v = " + text);
        if (const toml::node* node = doc.root.get("v"); node && doc.root.size() == 1)
        {
            const Span at = span(doc, *node);
            return {doc.text.substr(at.begin, at.end - at.begin), doc.root};
        }
    }
    catch (const Error&)
    {
    }
    throw fail("{} is no TOML value", text);
}

std::string set_key(const Document& doc, const Place& place, const Value& value)
{
    const toml::node* node = find(doc, place);
    if (!node)
        return insert_key(doc, place, value.text);
    if (same(*node, value.node()))
        return doc.text;
    if (!is_value(*node))
        return insert_key(parse(remove_key(doc, place)), place, value.text);
    return splice(doc, span(doc, *node), value.text);
}

// ---- Trusting nothing ----

// The tree with the wanted node in place, or with none there.
toml::table with(const toml::table& root, const Place& place, const toml::node* wanted)
{
    toml::table result = root;
    toml::table* table = &result;
    for (const auto& name : place.path)
    {
        if (!table->contains(name) && !wanted)
            return result;
        table = table->insert(name, toml::table{}).first->second.as_table();
    }
    table->erase(place.key);
    if (wanted)
        wanted->visit([&](const auto& node) { table->insert(place.key, node); });
    return result;
}

bool says(const std::string& text, const toml::table& wanted)
{
    try
    {
        return same(parse(text).root, wanted);
    }
    catch (const Error&)
    {
        return false;
    }
}

// What `patch` returns, if that says what is wanted. A patch may also end in any exception: a position that leads
// nowhere throws from the standard library.
template <typename Patch> std::string checked(const toml::table& wanted, Patch patch)
{
    try
    {
        const std::string patched = patch();
        if (says(patched, wanted))
            return patched;
    }
    catch (const std::exception&)
    {
    }
    std::ostringstream stream;
    stream << toml::toml_formatter(wanted) << '\n';
    if (!says(stream.str(), wanted))
        throw fail("the file cannot be rewritten without changing what it says; save under another name");
    return stream.str();
}

} // namespace

std::string edit_toml(const std::string& text, const std::vector<TomlEdit>& edits)
{
    Document doc = parse(text);
    for (const auto& edit : edits)
    {
        const Place place{split(edit.group), {}, edit.key};
        const toml::node* old = find(doc, place);
        std::optional<Value> value;
        if (edit.value)
            value = parse_value(*edit.value);
        const auto patch = [&] {
            return value ? set_key(doc, place, *value) : old ? remove_key(doc, place) : doc.text;
        };
        doc = parse(checked(with(doc.root, place, value ? &value->node() : nullptr), patch));
    }
    return doc.text;
}

namespace
{

// All entries as one value, on one line or on a line each.
Value inline_array(const std::vector<TomlEntry>& entries, bool on_lines)
{
    std::string text;
    for (const auto& entry : entries)
    {
        std::string items;
        for (const auto& [key, value] : entry)
            items += (items.empty() ? " " : ", ") + key_text(key) + " = " + parse_value(value).text;
        const std::string table = "{" + items + (items.empty() ? "}" : " }");
        text += on_lines ? "\n    " + table + "," : (text.empty() ? "" : ", ") + table;
    }
    return parse_value("[" + text + (on_lines ? "\n]" : "]"));
}

std::string patch_entry(std::string text, const Place& array, size_t index, const TomlEntry& entry)
{
    Place place{array.path, index, ""};
    place.path.push_back(array.key);
    std::vector<std::string> keys;
    const Document doc = parse(text);
    for (auto&& [key, value] : *reach(doc, place).table)
        keys.emplace_back(key.str());
    for (const auto& key : keys)
        if (std::none_of(entry.begin(), entry.end(), [&](const auto& item) { return item.first == key; }))
        {
            place.key = key;
            text = remove_key(parse(text), place);
        }
    for (const auto& [key, value] : entry)
    {
        place.key = key;
        text = set_key(parse(text), place, parse_value(value));
    }
    return text;
}

// The sections of the last entry, in the order of the text.
std::vector<Span> last_entry(const Document& doc, const Place& array)
{
    std::vector<Span> lines;
    const toml::array& entries = *find(doc, array)->as_array();
    collect_lines(doc, 0, *entries.get(entries.size() - 1), lines);
    std::sort(lines.begin(), lines.end(), [](Span a, Span b) { return a.begin < b.begin; });
    return lines;
}

// An entry goes with the blank line that append_section set before it.
std::string remove_last_entry(const Document& doc, const Place& array)
{
    std::vector<Span> lines = last_entry(doc, array);
    size_t& begin = lines.front().begin;
    if (begin > doc.line_begins[0] && !follows_text(doc, begin))
        begin = line_begin(doc, begin - 1);
    return remove_lines(doc, lines);
}

std::string append_entry(const Document& doc, const Place& array, const TomlEntry& entry)
{
    std::vector<std::string> path = array.path;
    path.push_back(array.key);
    std::string section = "[[" + dotted(path) + "]]\n";
    for (const auto& [key, value] : entry)
        section += key_text(key) + " = " + parse_value(value).text + "\n";
    return append_section(doc, find(doc, array) ? last_entry(doc, array).back().end : doc.text.size(), section);
}

std::string patch_by_headers(std::string text, size_t count, const Place& array, const std::vector<TomlEntry>& entries)
{
    for (; count > entries.size(); --count)
        text = remove_last_entry(parse(text), array);
    for (size_t i = 0; i < count; ++i)
        text = patch_entry(text, array, i, entries[i]);
    for (; count < entries.size(); ++count)
        text = append_entry(parse(text), array, entries[count]);
    return text;
}

} // namespace

std::string edit_toml_array(const std::string& text, const std::string& name, const std::vector<TomlEntry>& entries)
{
    assert(!name.empty());
    const Document doc = parse(text);
    Place array{split(name), {}, ""};
    array.key = array.path.back();
    array.path.pop_back();

    const toml::node* old = find(doc, array);
    const Span at = old ? span(doc, *old) : Span{0, 0};
    const bool on_lines =
        old && is_value(*old) && doc.text.substr(at.begin, at.end - at.begin).find('\n') != std::string::npos;
    const Value value = inline_array(entries, on_lines && !entries.empty());

    // What is left of an array without entries is nothing, or [] where it was written inline.
    const bool by_headers = old ? is_header_array(*old) : entries.empty() || !reach(doc, array).inline_table;
    const toml::table wanted = with(doc.root, array, by_headers && entries.empty() ? nullptr : &value.node());
    const size_t count = by_headers && old ? old->as_array()->size() : 0;
    return checked(wanted, [&]
                   { return by_headers ? patch_by_headers(text, count, array, entries) : set_key(doc, array, value); });
}

} // namespace coif
