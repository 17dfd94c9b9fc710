#include "sim/exchange/ogawa.h"

namespace coif
{

static constexpr uint64_t kIsData = uint64_t(1) << 63;

Ogawa::Ogawa(std::string_view bytes, const std::string& name)
    : bytes_{bytes, name}, work_left_(16 * uint64_t(bytes.size()) + 1024)
{
    bytes_.need(0, 1, 16, "header of 16 bytes");
    if (!bytes.starts_with("Ogawa"))
        throw fail("{}: at byte 0: is no Alembic file: it does not begin with Ogawa", name);
    if (bytes[5] != '\xff')
        throw fail("{}: at byte 5: was never finished by the program that wrote it: export it again", name);
    if (bytes[6] != 0 || bytes[7] != 1)
        throw fail("{}: at byte 6: is of an Ogawa version that coif does not know: export it as Alembic 1.5 or later",
                   name);
    const Group root = group(bytes_.value<uint64_t>(8, "header"));
    if (root.children < 6)
        throw fail("{}: at byte {}: its root has {} parts instead of 6: it is damaged", name, root.at, root.children);
    top_ = child(root, 2);
    const std::string_view table = data(child(root, 5));
    spend(table.size());
    metadata_.emplace_back();
    for (size_t at = 0; at < table.size();)
    {
        const size_t length = uint8_t(table[at]);
        if (length > table.size() - at - 1)
            throw fail("{}: its table of metadata is damaged", name);
        metadata_.push_back(table.substr(at + 1, length));
        at += 1 + length;
    }
}

void Ogawa::spend(uint64_t work)
{
    if (work > work_left_)
        throw fail("{}: its parts hold one another again and again: it is damaged", bytes_.name);
    work_left_ -= work;
}

Ogawa::Group Ogawa::group(uint64_t offset)
{
    spend(8);
    if (offset == 0 || offset == kIsData)
        return {};
    if (offset & kIsData)
        throw fail("{}: at byte {}: has data where a group should be: it is damaged", bytes_.name, offset & ~kIsData);
    const auto children = bytes_.value<uint64_t>(offset, "groups");
    bytes_.need(offset + 8, children, 8, "groups");
    return {offset, children};
}

uint64_t Ogawa::child(const Group& group, uint64_t index) const
{
    if (index >= group.children)
        throw fail("{}: at byte {}: a group has {} parts where more are said to be: it is damaged", bytes_.name,
                   group.at, group.children);
    return bytes_.value<uint64_t>(group.at + 8 + 8 * index, "groups");
}

std::string_view Ogawa::data(uint64_t offset) const
{
    if (offset == kIsData || offset == 0)
        return {};
    if (!(offset & kIsData))
        throw fail("{}: at byte {}: has a group where data should be: it is damaged", bytes_.name, offset);
    const uint64_t at = offset & ~kIsData;
    const auto size = bytes_.value<uint64_t>(at, "data");
    bytes_.need(at + 8, size, 1, "data");
    return bytes_.all.substr(at + 8, size);
}

std::string_view Ogawa::metadata(uint8_t index) const
{
    if (index >= metadata_.size())
        throw fail("{}: names metadata that it does not hold: it is damaged", bytes_.name);
    return metadata_[index];
}

std::vector<OgawaObject> Ogawa::children(const OgawaObject& object)
{
    std::vector<OgawaObject> found;
    const Group own = group(object.at);
    if (own.children < 2)
        return found;
    std::string_view headers = data(child(own, own.children - 1));
    spend(headers.size());
    constexpr size_t kHashes = 32;
    if (headers.size() < kHashes)
        return found;
    headers.remove_suffix(kHashes);
    const Bytes bytes{headers, bytes_.name};
    for (uint64_t at = 0, index = 1; at < headers.size(); ++index)
    {
        OgawaObject one;
        const auto length = bytes.value<uint32_t>(at, "names of objects");
        bytes.need(at + 4, length, 1, "names of objects");
        one.name = headers.substr(at + 4, length);
        at += 4 + uint64_t(length);
        const auto meta = bytes.value<uint8_t>(at, "names of objects");
        ++at;
        if (meta == 255)
        {
            const auto size = bytes.value<uint32_t>(at, "metadata");
            bytes.need(at + 4, size, 1, "metadata");
            one.metadata = headers.substr(at + 4, size);
            at += 4 + uint64_t(size);
        }
        else
            one.metadata = metadata(meta);
        if (index + 1 >= own.children)
            throw fail("{}: at byte {}: names more objects than it holds: it is damaged", bytes_.name, own.at);
        one.at = child(own, index);
        found.push_back(std::move(one));
    }
    return found;
}

std::vector<OgawaProperty> Ogawa::properties(const OgawaObject& object)
{
    const Group own = group(object.at);
    return own.children > 0 ? properties_at(child(own, 0)) : std::vector<OgawaProperty>{};
}

std::vector<OgawaProperty> Ogawa::properties(const OgawaProperty& compound)
{
    return compound.compound ? properties_at(compound.child) : std::vector<OgawaProperty>{};
}

std::vector<OgawaProperty> Ogawa::properties_at(uint64_t offset)
{
    std::vector<OgawaProperty> found;
    const Group own = group(offset);
    if (own.children == 0)
        return found;
    const std::string_view headers = data(child(own, own.children - 1));
    spend(headers.size());
    const Bytes bytes{headers, bytes_.name};
    for (uint64_t at = 0, index = 0; at < headers.size(); ++index)
    {
        const auto info = bytes.value<uint32_t>(at, "properties");
        at += 4;
        const unsigned hint = info >> 2 & 3;
        const auto number = [&]() -> uint64_t // all of a header are of one size
        {
            const uint64_t from = at;
            at += hint == 0 ? 1 : hint == 1 ? 2 : 4;
            if (hint == 0)
                return bytes.value<uint8_t>(from, "properties");
            return hint == 1 ? bytes.value<uint16_t>(from, "properties") : bytes.value<uint32_t>(from, "properties");
        };
        const auto text = [&]
        {
            const uint64_t length = number();
            bytes.need(at, length, 1, "names of properties");
            at += length;
            return headers.substr(at - length, length);
        };
        OgawaProperty one;
        const unsigned kind = info & 3;
        one.compound = kind == 0;
        one.scalar = kind == 1;
        if (!one.compound)
        {
            one.pod = int(info >> 4 & 15);
            one.extent = int(info >> 12 & 255);
            one.samples = number();
            if (info >> 9 & 1) // the first and the last sample that differ
            {
                number();
                number();
            }
            if (info >> 8 & 1) // time sampling
                number();
        }
        one.name = text();
        const unsigned meta = info >> 20 & 255;
        one.metadata = meta == 255 ? text() : metadata(uint8_t(meta));
        if (index + 1 >= own.children)
            throw fail("{}: at byte {}: names more properties than it holds: it is damaged", bytes_.name, own.at);
        one.child = child(own, index);
        found.push_back(std::move(one));
    }
    return found;
}

std::string_view Ogawa::first_sample(const OgawaProperty& property)
{
    if (property.compound || property.samples == 0)
        return {};
    const Group own = group(property.child);
    if (own.children == 0)
        return {};
    const std::string_view found = data(child(own, 0));
    spend(found.size());
    constexpr size_t kKey = 16; // a digest before the values
    return found.size() > kKey ? found.substr(kKey) : std::string_view{};
}

} // namespace coif
