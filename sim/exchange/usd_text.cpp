#include "sim/exchange/usd_text.h"

#include "sim/error.h"

#include <algorithm>
#include <charconv>

namespace coif
{

static constexpr size_t kMostDepth = 64;     // of prims in prims
static constexpr size_t kMostPrims = 100000; // each takes a hundred bytes, of text it need take no ten

void UsdText::complain(size_t at, const std::string& what) const
{
    const auto lines = std::count(text_.begin(), text_.begin() + long(std::min(at, text_.size())), '\n');
    throw fail("{}:{}: {}", name_, lines + 1, what);
}

size_t UsdText::space(size_t at) const
{
    while (at < text_.size())
        if (text_[at] == '#')
            at = std::min(text_.find('\n', at), text_.size());
        else if (text_[at] == ' ' || text_[at] == '\t' || text_[at] == '\n' || text_[at] == '\r' || text_[at] == ';')
            ++at;
        else
            break;
    return at;
}

size_t UsdText::word_end(size_t at) const
{
    constexpr std::string_view kEnds = " \t\r\n=()[]{},;#\"'@<>";
    return std::min(text_.find_first_of(kEnds, at), text_.size());
}

size_t UsdText::text_end(size_t at) const
{
    const char quote = text_[at];
    const std::string_view three = text_.substr(at, 3);
    if (three.size() == 3 && three[1] == quote && three[2] == quote)
    {
        for (size_t i = at + 3; i < text_.size(); ++i)
            if (text_[i] == '\\')
                ++i;
            else if (text_.substr(i, 3) == three)
                return i + 3;
    }
    else
        for (size_t i = at + 1; i < text_.size(); ++i)
            if (text_[i] == '\\' && quote != '@')
                ++i;
            else if (text_[i] == quote)
                return i + 1;
    complain(at, "a string has no end");
}

size_t UsdText::value_end(size_t at) const
{
    size_t open = 0;
    for (at = space(at); at < text_.size(); at = space(at))
    {
        const char c = text_[at];
        if (c == '"' || c == '\'' || c == '@')
            at = text_end(at);
        else if (c == '[' || c == '(' || c == '{')
        {
            ++open;
            ++at;
        }
        else if (c == ']' || c == ')' || c == '}')
        {
            if (open == 0)
                complain(at, fmt::format("a '{}' has no beginning", c));
            --open;
            ++at;
        }
        else if (c == '<')
            at = std::min(text_.find('>', at), text_.size() - 1) + 1;
        else if (c == ',' || c == '=')
            ++at;
        else
            at = std::max(word_end(at), at + 1);
        if (open == 0)
            return at;
    }
    complain(at, open ? "a bracket has no end: the file was not copied whole" : "a value is missing");
}

// A list in parentheses of what is said about the stage, a prim or an attribute, from its '(' on.
size_t UsdText::metadata(size_t at, bool of_stage, bool& off)
{
    const size_t end = value_end(at);
    for (at = space(at + 1); at + 1 < end; at = space(at))
    {
        const size_t word_at = at;
        if (text_[at] == '"' || text_[at] == '\'')
        {
            at = text_end(at);
            continue;
        }
        at = std::max(word_end(at), at + 1);
        const std::string_view word = text_.substr(word_at, at - word_at);
        size_t next = space(at);
        if (next >= end || text_[next] != '=')
            continue;
        next = space(next + 1);
        const size_t value_at = next;
        at = value_end(next);
        if (at > end)
            complain(value_at, "a value is missing");
        const std::string_view value = text_.substr(value_at, at - value_at);
        if (word == "references" || word == "payload" || word == "subLayers")
            ++references_;
        if (word == "active" && (value == "false" || value == "0"))
            off = true;
        if (of_stage && word == "upAxis" && value.size() >= 2)
            up_axis_ = value.substr(1, value.size() - 2);
        if (of_stage && word == "metersPerUnit")
        {
            std::from_chars(value.data(), value.data() + value.size(), meters_per_unit_);
            if (!(meters_per_unit_ > 1e-6 && meters_per_unit_ < 1e6))
                complain(value_at, fmt::format("metersPerUnit is {}, which is no length in metres", value));
        }
    }
    return end;
}

// One line of a prim: words, of which the last before '=' is the name, and a value. Returns where it ends.
size_t UsdText::attribute(size_t at, UsdPrim& prim)
{
    UsdAttribute found;
    const size_t begin = at;
    for (size_t words = 0;; ++words)
    {
        at = space(at);
        if (at >= text_.size() || text_[at] == '}' || text_[at] == '{')
            complain(begin, "is neither a prim nor an attribute");
        if (text_[at] == '=')
            break;
        if (text_[at] == '(') // said without a value
        {
            bool off = false;
            return metadata(at, false, off);
        }
        if (text_[at] == '[') // of the type
        {
            at = value_end(at);
            continue;
        }
        const size_t end = word_end(at);
        if (end == at)
            complain(at, fmt::format("'{}' is no word", text_[at]));
        found.name = text_.substr(at, end - at);
        at = end;
        // Without a value: the next line is another one.
        const size_t line_end = text_.find_first_not_of(" \t\r", at);
        if (words > 0 && (line_end == text_.npos || text_[line_end] == '\n' || text_[line_end] == ';' ||
                          text_[line_end] == '#' || text_[line_end] == '}'))
            return at;
    }
    found.value = space(at + 1);
    at = value_end(found.value);
    constexpr std::string_view kSamples = ".timeSamples";
    if (found.name.ends_with(kSamples))
    {
        found.name.remove_suffix(kSamples.size());
        found.samples = true;
    }
    constexpr std::string_view kWanted[] = {"points", "curveVertexCounts", "widths",        "type", "basis",
                                            "wrap",   "xformOpOrder",      "primvars:width"};
    if (std::ranges::find(kWanted, found.name) != std::end(kWanted) || found.name.starts_with("xformOp:") ||
        found.name.starts_with("primvars:"))
        prim.attributes.push_back(found);
    if (const size_t next = space(at); next < text_.size() && text_[next] == '(')
    {
        bool off = false;
        at = metadata(next, false, off);
    }
    return at;
}

UsdText::UsdText(std::string_view text, const std::string& name) : text_(text), name_(name)
{
    if (!text.starts_with("#usda"))
        complain(0, "is no USD text: it does not begin with #usda");
    if (text.find('\0') != text.npos)
        complain(text.find('\0'), "holds a zero byte: it is no text");
    size_t at = space(0);
    bool ignored = false;
    if (at < text.size() && text[at] == '(')
        at = metadata(at, true, ignored);
    // Open prims and, with -1 for a prim, other blocks: variants, of which nothing is chosen here, and dictionaries.
    std::vector<int> open;
    for (at = space(at); at < text.size(); at = space(at))
    {
        if (text[at] == '}')
        {
            if (open.empty())
                complain(at, "a '}' has no beginning");
            open.pop_back();
            ++at;
            continue;
        }
        const size_t word_at = at, end = word_end(at);
        const std::string_view word = text.substr(at, end - at);
        if (word == "variantSet")
        {
            ++references_;
            at = std::min(text.find('{', at), text.size());
            at = value_end(at);
            continue;
        }
        if (word != "def" && word != "over" && word != "class")
        {
            if (open.empty() && word != "reorder")
                complain(at, fmt::format("'{}' stands where a prim should begin", text.substr(at, 20)));
            UsdPrim nowhere;
            at = attribute(at, open.empty() ? nowhere : prims_[size_t(open.back())]);
            continue;
        }
        UsdPrim prim;
        prim.parent = open.empty() ? -1 : open.back();
        at = space(end);
        if (at < text.size() && text[at] != '"' && text[at] != '\'')
        {
            const size_t type_end = word_end(at);
            prim.type = text.substr(at, type_end - at);
            at = space(type_end);
        }
        if (at >= text.size() || (text[at] != '"' && text[at] != '\''))
            complain(word_at, "a prim has no name in quotes");
        const size_t name_end = text_end(at);
        prim.name = text.substr(at + 1, name_end - at - 2);
        prim.abstract = word == "class" || (prim.parent >= 0 && prims_[size_t(prim.parent)].abstract);
        at = space(name_end);
        if (at < text.size() && text[at] == '(')
            at = space(metadata(at, false, prim.abstract));
        if (at >= text.size() || text[at] != '{')
            complain(at, fmt::format("the prim '{}' has no {{ }}", prim.name));
        if (open.size() >= kMostDepth)
            complain(at, fmt::format("prims lie more than {} deep", kMostDepth));
        if (prims_.size() >= kMostPrims)
            complain(at, fmt::format("there are more prims than the {} that coif reads", kMostPrims));
        open.push_back(int(prims_.size()));
        prims_.push_back(std::move(prim));
        ++at;
    }
    if (!open.empty())
        complain(at, fmt::format("the prim '{}' has no end: the file was not copied whole",
                                 prims_[size_t(open.back())].name));
}

const UsdAttribute* UsdText::find(const UsdPrim& prim, std::string_view name) const
{
    const auto found = std::ranges::find(prim.attributes, name, &UsdAttribute::name);
    return found == prim.attributes.end() ? nullptr : &*found;
}

// Where the value begins or, of samples, that of the first time; the text's end where there is none.
size_t UsdText::first_value(const UsdAttribute& attribute) const
{
    size_t at = attribute.value;
    if (attribute.samples && text_[at] == '{')
    {
        const size_t end = value_end(at), colon = text_.find(':', at);
        at = colon < end ? space(colon + 1) : text_.size();
    }
    return text_.substr(std::min(at, text_.size()), 4) == "None" ? text_.size() : at;
}

template <typename T> std::vector<T> UsdText::values(const UsdAttribute& attribute) const
{
    std::vector<T> numbers;
    const size_t begin = first_value(attribute), end = begin < text_.size() ? value_end(begin) : begin;
    for (size_t at = begin; at < end;)
    {
        const char c = text_[at];
        if (c == ',' || c == '(' || c == ')' || c == '[' || c == ']' || c == '{' || c == '}')
            ++at;
        else if (const size_t after = space(at); after != at)
            at = after;
        else
        {
            T number = 0;
            const auto [next, error] = std::from_chars(text_.data() + at, text_.data() + end, number);
            if (error == std::errc::invalid_argument)
                complain(at, fmt::format("{} holds '{}', which is no number", attribute.name,
                                         text_.substr(at, std::min<size_t>(std::max(word_end(at), at + 1) - at, 20))));
            if (error == std::errc::result_out_of_range) // a tiny one is 0, a huge one is dropped later
                number = text_.substr(at, size_t(next - text_.data()) - at).find("e-") != text_.npos ? T(0) : T(1e30);
            numbers.push_back(number);
            at = size_t(next - text_.data());
        }
    }
    return numbers;
}

std::vector<double> UsdText::numbers(const UsdAttribute& attribute) const { return values<double>(attribute); }
std::vector<float> UsdText::floats(const UsdAttribute& attribute) const { return values<float>(attribute); }

std::vector<std::string_view> UsdText::texts(const UsdAttribute& attribute) const
{
    std::vector<std::string_view> found;
    const size_t begin = first_value(attribute), end = begin < text_.size() ? value_end(begin) : begin;
    for (size_t at = begin; at < end;)
        if (text_[at] == '"' || text_[at] == '\'')
        {
            const size_t after = text_end(at);
            found.push_back(text_.substr(at + 1, after - at - 2));
            at = after;
        }
        else
            ++at;
    return found;
}

} // namespace coif
