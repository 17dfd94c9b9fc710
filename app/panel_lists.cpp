#include "app/panel_lists.h"

#include "app/panel.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

namespace coif
{

namespace
{

// A widget for each field; `changed` says whether any was used.
struct FieldEditor
{
    const HostParams& host;
    bool changed = false;

    void text(const char* name, std::string& value, bool needed = false)
    {
        if (name == std::string_view("file")) // which a save names
        {
            if (!value.empty())
                ImGui::TextDisabled("in %s", value.c_str());
            return;
        }
        std::string edited = value;
        if (ImGui::InputText(name, &edited, ImGuiInputTextFlags_EnterReturnsTrue) && !(needed && edited.empty()))
        {
            changed |= edited != value;
            value = edited;
        }
    }
    // Of the named parts of a head, or of the style's regions, any.
    void texts(const char* name, std::vector<std::string>& values)
    {
        if (!ImGui::BeginCombo(name, values.empty() ? "anywhere" : fmt::format("{}", fmt::join(values, ", ")).c_str()))
            return;
        std::vector<std::string> names = region_areas();
        if (name == std::string_view("regions"))
        {
            names.clear();
            for (const Region& region : host.regions)
                names.push_back(region.name);
        }
        for (const std::string& area : names)
        {
            const auto found = std::find(values.begin(), values.end(), area);
            if (!ImGui::Selectable(area.c_str(), found != values.end(), ImGuiSelectableFlags_DontClosePopups))
                continue;
            if (found != values.end())
                values.erase(found);
            else
                values.push_back(area);
            changed = true;
        }
        ImGui::EndCombo();
    }
    void number(const char* name, float& value, Limits limits, bool = false)
    {
        const bool wide =
            limits.min > 0.0f ? limits.max > 40.0f * limits.min : limits.min == 0.0f && limits.max >= 100.0f;
        changed |= ImGui::SliderFloat(name, &value, limits.min, limits.max,
                                      *limits.unit ? fmt::format("%.4g {}", limits.unit).c_str() : "%.4g",
                                      ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : 0));
    }
    void numbers(const char* name, std::vector<float>& values, Limits)
    {
        if (values.empty())
            return;
        ImGui::Text("%zu %s", values.size(), name);
        ImGui::SameLine();
        ImGui::TextDisabled("painted");
    }
    void point(const char* name, glm::vec3& value, Limits limits, bool = false)
    {
        changed |= ImGui::DragFloat3(name, &value.x, 0.001f, limits.min, limits.max,
                                     fmt::format("%.3f {}", limits.unit).c_str(), ImGuiSliderFlags_AlwaysClamp);
    }
    void optional_point(const char* name, std::optional<glm::vec3>& value, Limits limits)
    {
        if (value)
            point(name, *value, limits);
    }
    void points(const char* name, std::vector<glm::vec3>& values, Limits limits)
    {
        for (size_t i = 0; i < values.size(); ++i)
        {
            ImGui::PushID(int(i));
            point("##point", values[i], limits);
            ImGui::SameLine();
            if (values.size() > 2 && ImGui::SmallButton("x"))
            {
                values.erase(values.begin() + ptrdiff_t(i));
                changed = true;
            }
            ImGui::PopID();
        }
        if (values.size() >= 2 && values.size() < 256 && ImGui::SmallButton(fmt::format("add to {}", name).c_str()))
        {
            const glm::vec3 last = values.back();
            values.push_back(last + 0.5f * (last - values[values.size() - 2]));
            changed = true;
        }
    }
    void planes(const char* name, std::vector<glm::vec4>& values, Limits limits)
    {
        for (size_t i = 0; i < values.size(); ++i)
        {
            ImGui::PushID(int(i));
            glm::vec4 plane = values[i];
            if (ImGui::DragFloat4("##plane", &plane.x, 0.002f, limits.min, limits.max, "%.3f",
                                  ImGuiSliderFlags_AlwaysClamp) &&
                plane.x * plane.x + plane.y * plane.y + plane.z * plane.z > 1e-6f)
            {
                values[i] = plane;
                changed = true;
            }
            ImGui::SameLine();
            if (ImGui::SmallButton("x"))
            {
                values.erase(values.begin() + ptrdiff_t(i));
                changed = true;
            }
            ImGui::PopID();
        }
        if (ImGui::SmallButton(fmt::format("add to {}", name).c_str()))
        {
            values.emplace_back(0.0f, 1.0f, 0.0f, 0.0f);
            changed = true;
        }
    }
    void color(const char* name, glm::vec3& value) { changed |= ImGui::ColorEdit3(name, &value.x); }
    void flag(const char* name, bool& value) { changed |= ImGui::Checkbox(name, &value); }
    template <typename Choice> void choice(const char* name, Choice& value, const char* labels)
    {
        std::string items = labels;
        std::replace(items.begin(), items.end(), '|', '\0');
        items += '\0';
        int now = int(value);
        if (ImGui::Combo(name, &now, items.c_str()))
        {
            value = Choice(now);
            changed = true;
        }
    }
    // The region's own values, and one more of those that may vary.
    void settings(std::vector<Setting>& values)
    {
        for (size_t i = 0; i < values.size(); ++i)
        {
            Setting& setting = values[i];
            const ParamInfo& info = *setting.info;
            ImGui::PushID(info.path().c_str());
            if (info.kind == Kind::COLOR)
                changed |= ImGui::ColorEdit3("##value", &setting.value.x);
            else
                changed |= ImGui::SliderFloat("##value", &setting.value.x, info.min, info.max,
                                              fmt::format("%.4g {}", info.unit).c_str(), ImGuiSliderFlags_AlwaysClamp);
            ImGui::SameLine();
            const bool remove = ImGui::SmallButton("x");
            ImGui::SameLine();
            ImGui::TextUnformatted(info.path().c_str());
            ImGui::PopID();
            if (remove)
            {
                values.erase(values.begin() + ptrdiff_t(i));
                changed = true;
                return;
            }
        }
        if (!ImGui::BeginCombo("##set", "set another parameter"))
            return;
        for (const ParamInfo& info : param_table())
        {
            const bool there = std::ranges::find(values, &info, &Setting::info) != values.end();
            if (info.scope != Scope::STRAND || info.on_host() || there || !ImGui::Selectable(info.path().c_str()))
                continue;
            Setting& setting = values.emplace_back(Setting{&info, glm::vec4(0.0f)});
            get_numbers({}, info, &setting.value.x);
            std::ranges::sort(values, {}, &Setting::info); // as a file would give them
            changed = true;
            break;
        }
        ImGui::EndCombo();
    }
};

} // namespace

// What a button adds. A list without one is painted, not typed.
static bool add_entry(std::vector<Collider>& list, size_t most)
{
    if (list.size() >= most)
        return false;
    const bool sphere = ImGui::Button("add a sphere");
    ImGui::SameLine();
    const bool capsule = ImGui::Button("add a capsule");
    if (!sphere && !capsule)
        return false;
    list.push_back({glm::vec3(0.2f, 0.0f, 0.1f), 0.05f, false, {}});
    if (capsule)
        list.back().to = glm::vec3(0.2f, -0.2f, 0.1f);
    return true;
}

// "light 1", or with the first number that none has yet.
template <typename Entry> static std::string unused_name(const std::vector<Entry>& list, const char* kind)
{
    for (int i = 1;; ++i)
        if (const std::string name = fmt::format("{} {}", kind, i);
            std::ranges::find(list, name, &Entry::name) == list.end())
            return name;
}

std::string unused_region(const std::vector<Region>& regions) { return unused_name(regions, "region"); }

static bool add_entry(std::vector<Region>& list, size_t most)
{
    if (list.size() >= most || !ImGui::Button("add a region"))
        return false;
    Region region;
    region.name = unused_region(list);
    region.where = {"top"};
    list.push_back(region);
    return true;
}

static bool add_entry(std::vector<Parting>& list, size_t most)
{
    if (list.size() >= most || !ImGui::Button("add a parting"))
        return false;
    list.push_back({{{0.0f, 0.07f, 0.09f}, {0.0f, 0.11f, 0.02f}, {0.0f, 0.09f, -0.04f}}});
    return true;
}

static bool add_entry(std::vector<ScalpMap>& list, size_t)
{
    if (list.empty())
        ImGui::TextDisabled("none yet: brushes (s) paint them");
    return false;
}

static bool add_entry(std::vector<Tie>& list, size_t most)
{
    if (list.size() >= most || !ImGui::Button("add a tie"))
        return false;
    Tie tie;
    tie.name = fmt::format("tie {}", list.size() + 1);
    list.push_back(tie);
    return true;
}

static bool add_entry(std::vector<Light>& list, size_t most)
{
    if (list.size() >= most || !ImGui::Button("add a light"))
        return false;
    Light light;
    light.name = unused_name(list, "light");
    list.push_back(light);
    return true;
}

static std::string title_of(const Collider& c, size_t i)
{
    return fmt::format("{} {}", c.to ? "capsule" : "sphere", i + 1);
}
static std::string title_of(const Region& region, size_t) { return region.name; }
static std::string title_of(const Parting&, size_t i) { return fmt::format("parting {}", i + 1); }
static std::string title_of(const Tie& tie, size_t i)
{
    return tie.name.empty() ? fmt::format("tie {}", i + 1) : tie.name;
}
static std::string title_of(const Light& light, size_t i)
{
    return light.name.empty() ? fmt::format("light {}", i + 1) : light.name;
}
static std::string title_of(const ScalpMap& map, size_t) { return "map of " + map.of; }

// Takes an entry back to what it was where its neighbours do not allow what it has become, and says so below it. Ties
// go with the names of the regions that they gather.
template <typename Entry>
static void keep_with_neighbors(HostParams& host, std::vector<Entry>& list, size_t i, const Entry& before, bool changed)
{
    if constexpr (std::is_same_v<Entry, Light>)
        if (!points_somewhere(list[i].direction))
            list[i] = before;
    if constexpr (std::is_same_v<Entry, Region>)
    {
        Region& region = list[i];
        bool* twice = ImGui::GetStateStorage()->GetBoolRef(ImGui::GetID("twice"), false);
        if (changed)
            *twice = std::ranges::count(list, region.name, &Region::name) > 1;
        if (changed && *twice)
            region = before;
        for (Tie& tie : host.ties)
            std::ranges::replace(tie.regions, before.name, region.name);
        if (*twice)
            ImGui::TextColored(ImVec4(1.0f, 0.5f, 0.4f, 1.0f), "Another region is called so; each needs its own name.");
    }
}

// Of lights with a mark at the one that the mouse turns where it takes none.
template <typename Entry> static void draw_title(const Entry& entry, size_t i, PanelState& state)
{
    const std::string title = title_of(entry, i);
    if constexpr (std::is_same_v<Entry, Light>)
    {
        if (ImGui::RadioButton(fmt::format("{}###chosen", title).c_str(), state.light == i))
            state.light = i;
        state.places[fmt::format("light[{}]", i)] = last_widget();
    }
    else
        ImGui::TextUnformatted(title.c_str());
}

static bool draw_entries(HostParams& host, const ParamInfo& info, PanelState& state)
{
    const size_t most = most_entries(info);
    return with_list(host, info,
                     [&](auto& list)
                     {
                         bool changed = false;
                         for (size_t i = 0; i < list.size(); ++i)
                         {
                             ImGui::PushID(int(i));
                             draw_title(list[i], i, state);
                             explain(info.help);
                             ImGui::SameLine();
                             const bool remove = ImGui::SmallButton("remove");
                             const auto before = list[i];
                             FieldEditor editor{host};
                             ImGui::PushItemWidth(ImGui::GetWindowWidth() * 0.5f);
                             fields(editor, list[i]);
                             ImGui::PopItemWidth();
                             keep_with_neighbors(host, list, i, before, editor.changed);
                             changed |= editor.changed;
                             ImGui::PopID();
                             if (remove)
                             {
                                 list.erase(list.begin() + ptrdiff_t(i));
                                 return true;
                             }
                         }
                         ImGui::PushID(info.group);
                         changed |= add_entry(list, most);
                         ImGui::PopID();
                         return changed;
                     });
}

bool draw_list(HostParams& host, const ParamInfo& info, PanelState& state)
{
    const bool replaced = info.group == std::string_view("light") && !host.look_lights.empty();
    if (replaced)
        ImGui::TextDisabled("%s shines in their place", host.look_lights.c_str());
    ImGui::BeginDisabled(replaced);
    const bool changed = draw_entries(host, info, state);
    ImGui::EndDisabled();
    return changed;
}

} // namespace coif
