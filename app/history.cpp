#include "app/history.h"

#include <fmt/format.h>

#include <algorithm>

namespace coif
{

std::string difference(const Hairstyle& a, const Hairstyle& b)
{
    std::string first;
    int more = -1;
    for (const ParamInfo& info : param_table())
    {
        if (same_value(a, b, info))
            continue;
        if (++more == 0)
            first = info.kind == Kind::LIST
                        ? info.path()
                        : fmt::format("{} {} to {}", info.path(), value_text(a, info), value_text(b, info));
        else if (more == 1)
            first = first.substr(0, first.find(' '));
    }
    return more > 0 ? fmt::format("{} and {} more", first, more) : first;
}

History begin_history(const Hairstyle& style, const Hairstyle& saved)
{
    return {{{"opened " + style.name(), style, saved}}, 0};
}

bool note_edit(History& history, const Hairstyle& style, const Hairstyle& saved, const std::string& what)
{
    const Edit& last = history.edits.at(history.now);
    const std::string done = difference(last.style, style);
    if (done.empty() && style.file == last.style.file && same_variants(style, last.style))
        return false;
    history.edits.resize(history.now + 1);
    history.edits.push_back({what.empty() ? done : what, style, saved});
    if (history.edits.size() > kMostEdits)
        history.edits.erase(history.edits.begin());
    history.now = history.edits.size() - 1;
    return true;
}

const Edit& go_to(History& history, size_t edit)
{
    history.now = std::min(edit, history.edits.size() - 1);
    return history.edits[history.now];
}

void note_save(History& history, const Hairstyle& saved)
{
    const auto save = [&](Edit& edit)
    {
        edit.style.file = saved.file;
        edit.style.text = saved.text;
        edit.saved = saved;
    };
    // What was done to the file on screen goes with it, under whatever name it was saved.
    const std::filesystem::path was = history.edits[history.now].style.file;
    for (size_t i = history.now; i < history.edits.size() && history.edits[i].style.file == was; ++i)
        save(history.edits[i]);
    for (size_t i = history.now; i-- > 0 && history.edits[i].style.file == was;)
        save(history.edits[i]);
    for (Edit& edit : history.edits)
        if (edit.style.file == saved.file)
            save(edit);
}

} // namespace coif
