// The container that Alembic files are since 2013: groups and data by their offsets, objects and properties in them.
#pragma once
#include "sim/exchange/bytes.h"

namespace coif
{

// A property of an object: a scalar, an array, or a compound of further ones.
struct OgawaProperty
{
    std::string_view name, metadata; // in the file's bytes; of the latter "key=value;..."
    bool compound = false, scalar = false;
    int pod = 0, extent = 1;
    uint64_t samples = 0;
    uint64_t child = 0; // where its samples or its own properties lie
};

struct OgawaObject
{
    std::string_view name, metadata;
    uint64_t at = 0; // of its group
};

enum OgawaPod
{
    POD_U8 = 1,
    POD_I32 = 6,
    POD_U32 = 5,
    POD_F32 = 10,
    POD_F64 = 11,
    POD_STRING = 12
};

// An archive. Offsets may point anywhere, so that groups could hold themselves, or one another a thousand times: all
// that is read of them is counted, and no more of it is read than a few times the file's size.
class Ogawa
{
  public:
    Ogawa(std::string_view bytes, const std::string& name);

    uint64_t top() const { return top_; }
    std::vector<OgawaObject> children(const OgawaObject& object);
    std::vector<OgawaProperty> properties(const OgawaObject& object);
    std::vector<OgawaProperty> properties(const OgawaProperty& compound);
    // The first sample's values, as they lie; empty where there is none.
    std::string_view first_sample(const OgawaProperty& property);

  private:
    struct Group
    {
        uint64_t at = 0, children = 0;
    };
    Group group(uint64_t offset);
    uint64_t child(const Group& group, uint64_t index) const;
    std::string_view data(uint64_t offset) const;
    std::vector<OgawaProperty> properties_at(uint64_t offset);
    std::string_view metadata(uint8_t index) const;
    void spend(uint64_t work);

    Bytes bytes_;
    uint64_t top_ = 0;
    uint64_t work_left_;
    std::vector<std::string_view> metadata_;
};

} // namespace coif
