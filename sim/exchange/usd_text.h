// USD's text form, as far as curves need it: prims in prims and their attributes, whose values are read when asked for.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace coif
{

struct UsdAttribute
{
    std::string_view name; // without namespaces' types: "primvars:displayColor"
    size_t value = 0;      // where it begins in the text
    bool samples = false;  // of time: { 0: ..., 1: ... }
};

struct UsdPrim
{
    std::string_view type, name;
    int parent = -1;       // index; -1: the stage
    bool abstract = false; // a class, or within one or within what is switched off
    std::vector<UsdAttribute> attributes;
};

class UsdText
{
  public:
    // Parses the whole text but for the values. Throws Error with the line.
    UsdText(std::string_view text, const std::string& name);

    const std::vector<UsdPrim>& prims() const { return prims_; } // parents first
    std::string_view up_axis() const { return up_axis_; }        // empty: not said
    double meters_per_unit() const { return meters_per_unit_; }  // 0: not said
    size_t references() const { return references_; }            // to other files

    const UsdAttribute* find(const UsdPrim& prim, std::string_view name) const;
    // All numbers of a value, whatever the brackets about them; of samples, the first one's.
    std::vector<double> numbers(const UsdAttribute& attribute) const;
    std::vector<float> floats(const UsdAttribute& attribute) const;
    std::vector<std::string_view> texts(const UsdAttribute& attribute) const; // strings and tokens, without quotes

  private:
    template <typename T> std::vector<T> values(const UsdAttribute& attribute) const;
    [[noreturn]] void complain(size_t at, const std::string& what) const;
    size_t space(size_t at) const; // after blanks and comments
    size_t word_end(size_t at) const;
    size_t text_end(size_t at) const;  // after the string that begins here
    size_t value_end(size_t at) const; // after the value that begins here, brackets and all
    size_t metadata(size_t at, bool of_stage, bool& off);
    size_t attribute(size_t at, UsdPrim& prim);
    size_t first_value(const UsdAttribute& attribute) const;

    std::string_view text_;
    const std::string& name_;
    std::vector<UsdPrim> prims_;
    std::string_view up_axis_;
    double meters_per_unit_ = 0.0;
    size_t references_ = 0;
};

} // namespace coif
