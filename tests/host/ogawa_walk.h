// What an Alembic file holds, by walking its groups: from the layout, without a thought of who wrote it. Throws
// std::out_of_range where an offset or a size points out of the file.
#pragma once
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace coif::test
{

struct WalkedProperty
{
    std::string meta;
    uint32_t kind = 0, pod = 0, extent = 0, times = 0;
    size_t declared = 0;
    bool constant = false;
    std::vector<std::string> samples, keys; // without and of their digests

    template <typename T> std::vector<T> values(size_t sample = 0) const
    {
        std::vector<T> out(samples.at(sample).size() / sizeof(T));
        std::memcpy(out.data(), samples[sample].data(), out.size() * sizeof(T));
        return out;
    }
};

struct OgawaWalk
{
    std::map<std::string, std::string> objects;       // "/hair/strands" -> metadata
    std::map<std::string, WalkedProperty> properties; // "/hair/strands:.geom/P"
    std::string archive, times;

    explicit OgawaWalk(std::string file) : bytes_(std::move(file))
    {
        if (bytes_.substr(0, 8) != std::string("Ogawa\xff\0\1", 8))
            throw std::out_of_range("no whole Ogawa file");
        const std::vector<uint64_t> root = children(at<uint64_t>(8));
        archive = data(root.at(3));
        times = data(root.at(4));
        metas_ = {""};
        const std::string table = data(root.at(5));
        for (size_t i = 0; i < table.size(); i += 1 + uint8_t(table[i]))
            metas_.push_back(table.substr(i + 1, uint8_t(table[i])));
        object(root.at(2), "");
    }

  private:
    template <typename T> T at(size_t place) const
    {
        T value;
        if (place + sizeof value > bytes_.size())
            throw std::out_of_range("beyond the end");
        std::memcpy(&value, bytes_.data() + place, sizeof value);
        return value;
    }
    std::vector<uint64_t> children(uint64_t group) const
    {
        std::vector<uint64_t> all;
        for (uint64_t i = 0; group && i < at<uint64_t>(group); ++i)
            all.push_back(at<uint64_t>(group + 8 + 8 * i));
        return all;
    }
    std::string data(uint64_t offset) const
    {
        if (!(offset >> 63))
            throw std::out_of_range("a group where data was due");
        offset &= ~(uint64_t(1) << 63);
        if (!offset)
            return {};
        const uint64_t size = at<uint64_t>(offset);
        if (offset + 8 + size > bytes_.size())
            throw std::out_of_range("data beyond the end");
        return bytes_.substr(offset + 8, size);
    }
    void compound(uint64_t group, const std::string& where)
    {
        const std::vector<uint64_t> all = children(group);
        if (all.empty())
            return;
        const std::string headers = data(all.back());
        size_t i = 0, child = 0;
        const auto number = [&](uint32_t bytes)
        {
            size_t value = 0;
            for (uint32_t b = 0; b < bytes; ++b)
                value |= size_t(uint8_t(headers.at(i++))) << 8 * b;
            return value;
        };
        while (i < headers.size())
        {
            const uint32_t info = uint32_t(number(4)), size = 1u << (info >> 2 & 3);
            WalkedProperty p;
            p.kind = info & 3;
            if (p.kind)
            {
                p.declared = number(size);
                if (info & 0x200)
                    i += 2 * size;
                if (info & 0x100)
                    p.times = uint32_t(number(size));
            }
            const size_t length = number(size);
            const std::string name = headers.substr(i, length);
            i += length;
            p.meta = metas_.at(info >> 20 & 255);
            p.pod = info >> 4 & 15;
            p.extent = info >> 12 & 255;
            p.constant = info >> 11 & 1;
            const uint64_t own = all.at(child++);
            if (p.kind == 0)
                compound(own, where + name + "/");
            else
            {
                const std::vector<uint64_t> stored = children(own);
                for (size_t k = 0; k<stored.size(); k += p.kind> 1 ? 2 : 1)
                {
                    const std::string sample = data(stored[k]);
                    p.keys.push_back(sample.substr(0, 16));
                    p.samples.push_back(sample.substr(16));
                }
            }
            properties[where + name] = p;
        }
    }
    void object(uint64_t group, const std::string& where)
    {
        const std::vector<uint64_t> all = children(group);
        compound(all.at(0), where + ":");
        if (all.size() < 2)
            return;
        const std::string whole = data(all.back()), headers = whole.substr(0, whole.size() - 32);
        for (size_t i = 0, child = 1; i < headers.size(); ++child)
        {
            uint32_t length = 0;
            std::memcpy(&length, headers.data() + i, 4);
            const std::string name = where + "/" + headers.substr(i + 4, length);
            i += 4 + length;
            objects[name] = metas_.at(uint8_t(headers.at(i++)));
            object(all.at(child), name);
        }
    }

    std::string bytes_;
    std::vector<std::string> metas_;
};

} // namespace coif::test
