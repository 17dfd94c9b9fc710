// The editor's window of presets, and how its windows are arranged from one run to the next.
#include "app/editor.h"
#include "app/folders.h"
#include "app/presets.h"
#include "sim/error.h"
#include "sim/source.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cstdint>

namespace coif
{

namespace fs = std::filesystem;

static constexpr float kCell = 128.0f;    // pixels a side of a picture
static constexpr double kListEvery = 1.0; // s

void Editor::browse(bool on)
{
    browser_.shown = on;
    redraw_ = kRedraw;
    if (on && !thumbnails_)
        thumbnails_ = std::make_unique<Thumbnails>(cache_folder().empty() ? fs::path() : cache_folder() / "thumbnails",
                                                   coif_program(), device_wish_);
    if (on && browser_.folder.empty())
        browser_.folder = fs::absolute(style_.file).parent_path();
    browser_.listed = -1e9;
    if (on)
        return;
    for (const auto& [file, picture] : browser_.pictures)
        glDeleteTextures(1, &picture.second);
    browser_.pictures.clear();
}

// A picture to click on, or what stands for it meanwhile. True when it is clicked.
bool Editor::draw_thumbnail(const fs::path& file)
{
    const Thumbnails::Entry& entry = thumbnails_->of(file);
    auto& [version, texture] = browser_.pictures[file];
    if (version != entry.version && !entry.image.pixels.empty())
    {
        version = entry.version;
        if (!texture)
            glGenTextures(1, &texture);
        glBindTexture(GL_TEXTURE_2D, texture);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, entry.image.width, entry.image.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     entry.image.pixels.data());
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    }
    const ImVec2 low = ImGui::GetCursorScreenPos(), high(low.x + kCell, low.y + kCell);
    const bool clicked = ImGui::InvisibleButton("picture", ImVec2(kCell, kCell));
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    if (texture && entry.state != Thumbnails::Entry::FAILED)
        draw.AddImage(reinterpret_cast<ImTextureID>(intptr_t(texture)), low, high);
    else
        draw.AddRectFilled(low, high, IM_COL32(44, 48, 54, 255));
    const char* word = entry.state == Thumbnails::Entry::FAILED ? "no picture" : texture ? "" : "to be drawn...";
    const ImVec2 size = ImGui::CalcTextSize(word);
    draw.AddText(ImVec2(0.5f * (low.x + high.x - size.x), 0.5f * (low.y + high.y - size.y)),
                 entry.state == Thumbnails::Entry::FAILED ? IM_COL32(240, 130, 110, 255) : IM_COL32(150, 155, 165, 255),
                 word);
    if (file == browser_.selected)
        draw.AddRect(low, high, ImGui::GetColorU32(ImGuiCol_CheckMark), 0.0f, 0, 2.0f);
    else if (ImGui::IsItemHovered())
        draw.AddRect(low, high, IM_COL32(200, 200, 200, 120));
    if (ImGui::IsItemHovered())
    {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(ImGui::GetFontSize() * 30.0f);
        ImGui::TextUnformatted(file.c_str());
        if (entry.state == Thumbnails::Entry::FAILED)
            ImGui::TextColored(ImVec4(1.0f, 0.5f, 0.4f, 1.0f), "%s", entry.why.c_str());
        else
            ImGui::TextDisabled("double click to open");
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
    return clicked;
}

// A name that fits under its picture.
static std::string fitting(const std::string& name, float width)
{
    std::string text = name;
    while (!text.empty() && ImGui::CalcTextSize((text + "...").c_str()).x > width)
        text.pop_back();
    return ImGui::CalcTextSize(name.c_str()).x <= width ? name : text + "...";
}

void Editor::draw_browser()
{
    Browser& b = browser_;
    b.places.clear();
    const double now = double(SDL_GetTicks64()) * 1e-3;
    if (now > b.listed + kListEvery)
    {
        b.files = hairstyles_in(b.folder);
        b.listed = now;
    }
    // Beside the head, two or three pictures wide.
    ImGui::SetNextWindowPos(ImVec2(float(view_width_) - 8.0f, 8.0f), ImGuiCond_FirstUseEver, ImVec2(1.0f, 0.0f));
    ImGui::SetNextWindowSize(ImVec2(view_width_ > 1000 ? 450.0f : 320.0f, 0.62f * float(view_height_)),
                             ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSizeConstraints(ImVec2(320.0f, 240.0f), ImVec2(4096.0f, 4096.0f));
    bool open = true;
    if (!ImGui::Begin("presets", &open, ImGuiWindowFlags_NoCollapse))
    {
        ImGui::End();
        return;
    }
    keep_in_view(float(view_width_), float(view_height_));
    const fs::path shipped = data_folder() / "hairstyles", beside = fs::absolute(style_.file).parent_path();
    const auto title = [&](const fs::path& folder) { return folder == shipped ? "coif's own" : folder.string(); };
    ImGui::SetNextItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
    if (ImGui::BeginCombo("##folder",
                          fitting(title(b.folder), 0.5f * ImGui::GetContentRegionAvail().x - 34.0f).c_str()))
    {
        std::vector<fs::path> folders = {shipped};
        for (const fs::path& more : {beside, b.folder})
            if (std::ranges::find(folders, more) == folders.end())
                folders.push_back(more);
        for (const fs::path& folder : folders)
            if (ImGui::Selectable(title(folder).c_str(), folder == b.folder))
            {
                b.folder = folder;
                b.listed = -1e9;
                b.selected.clear();
            }
        ImGui::EndCombo();
    }
    explain(b.folder.string());
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1.0f);
    ImGui::InputTextWithHint("##name", "find by name", &b.filter);
    b.places["filter"] = last_widget();

    const auto ask = [&](const char* label, bool possible, const std::string& name, const char* help)
    {
        ImGui::BeginDisabled(!possible);
        if (ImGui::Button(label))
        {
            b.asked = label;
            b.name = name;
        }
        b.places[label] = last_widget();
        explain(help);
        ImGui::EndDisabled();
        ImGui::SameLine();
    };
    const bool chosen = std::ranges::find(b.files, b.selected) != b.files.end();
    if (!chosen)
        b.selected.clear();
    const std::string stem = b.selected.stem().string();
    ImGui::BeginDisabled(!chosen);
    if (ImGui::Button("Open") && chosen)
        this->open(b.selected);
    b.places["Open"] = last_widget();
    explain("Opens what is chosen, as a double click on its picture does.");
    ImGui::EndDisabled();
    ImGui::SameLine();
    ask("New", true, unused_hairstyle(b.folder, "new"), "A plain hairstyle in this folder.");
    ask("Duplicate", chosen, chosen ? unused_hairstyle(b.folder, stem) : "", "A copy with all that lies beside it.");
    ask("Rename", chosen, stem, "Gives the file another name.");
    ImGui::BeginDisabled(!chosen);
    if (ImGui::Button("Delete"))
    {
        b.asked = "Delete";
        change_preset();
        b.asked.clear();
    }
    b.places["Delete"] = last_widget();
    ImGui::EndDisabled();
    explain("Moves it into the folder 'trash' beside it.");

    const std::vector<fs::path> shown = filtered(b.files, b.filter);
    ImGui::BeginChild("pictures");
    const float step = kCell + ImGui::GetStyle().ItemSpacing.x;
    const int columns = std::max(1, int((ImGui::GetContentRegionAvail().x + ImGui::GetStyle().ItemSpacing.x) / step));
    fs::path wanted;
    for (size_t i = 0; i < shown.size(); ++i)
    {
        const fs::path& file = shown[i];
        if (i % size_t(columns))
            ImGui::SameLine();
        ImGui::PushID(file.c_str());
        ImGui::BeginGroup();
        const float height = kCell + ImGui::GetTextLineHeightWithSpacing();
        if (ImGui::IsRectVisible(ImVec2(kCell, height)))
        {
            if (draw_thumbnail(file))
                b.selected = file;
            b.places[file.filename().string()] = last_widget();
            if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
                wanted = file;
            const bool current = file == fs::absolute(style_.file);
            ImGui::TextColored(current ? ImVec4(1.0f, 0.78f, 0.35f, 1.0f) : ImGui::GetStyleColorVec4(ImGuiCol_Text),
                               "%s", fitting(file.stem().string(), kCell).c_str());
        }
        else
            ImGui::Dummy(ImVec2(kCell, height)); // nobody sees it, so it need not be drawn yet
        ImGui::EndGroup();
        ImGui::PopID();
    }
    if (shown.empty())
        ImGui::TextDisabled(b.files.empty() ? "no hairstyles in this folder" : "none is called so");
    ImGui::EndChild();
    ImGui::End();
    if (!wanted.empty())
        this->open(wanted);
    draw_browser_dialog();
    if (!open)
        browse(false);
}

void Editor::draw_browser_dialog()
{
    Browser& b = browser_;
    if (b.asked.empty())
        return;
    if (!ImGui::IsPopupOpen("name of the hairstyle"))
        ImGui::OpenPopup("name of the hairstyle");
    ImGui::SetNextWindowPos(ImVec2(0.5f * float(view_width_), 0.4f * float(view_height_)), 0, ImVec2(0.5f, 0.5f));
    if (!ImGui::BeginPopupModal("name of the hairstyle", nullptr, ImGuiWindowFlags_AlwaysAutoResize))
        return;
    ImGui::SetNextItemWidth(300.0f);
    if (ImGui::IsWindowAppearing())
        ImGui::SetKeyboardFocusHere();
    const bool enter =
        ImGui::InputText("##name", &b.name, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    const bool taken = !b.name.empty() && std::ranges::find(b.files, b.folder / (b.name + ".toml")) != b.files.end();
    if (taken)
        ImGui::TextColored(ImVec4(1.0f, 0.78f, 0.35f, 1.0f), "There is one of that name.");
    ImGui::BeginDisabled(taken || b.name.empty());
    const bool go = ImGui::Button(b.asked.c_str());
    ImGui::EndDisabled();
    ImGui::SameLine();
    const bool cancel = ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (go || (enter && !taken && !b.name.empty()))
        change_preset();
    if (go || cancel || (enter && !taken))
    {
        b.asked.clear();
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
}

void Editor::change_preset()
{
    Browser& b = browser_;
    guarded(
        [&]
        {
            if (b.asked == "New")
                b.selected = new_hairstyle(b.folder, b.name);
            else if (b.asked == "Duplicate")
                b.selected = duplicate_hairstyle(b.selected, b.name);
            else if (b.asked == "Delete")
            {
                const fs::path trash = trash_hairstyle(b.selected);
                say("moved to " + trash.string());
                b.selected.clear();
            }
            else if (b.asked == "Rename")
            {
                const fs::path before = b.selected, after = rename_hairstyle(before, b.name);
                b.selected = after;
                const auto follow = [&](Hairstyle& style)
                {
                    if (!style.file.empty() && fs::absolute(style.file) == before)
                        style.file = after;
                };
                follow(style_);
                follow(saved_);
                for (Edit& edit : history_.edits)
                {
                    follow(edit.style);
                    follow(edit.saved);
                }
                apply();
            }
        });
    b.listed = -1e9;
    redraw_ = kRedraw;
}

static fs::path settings_file() { return config_folder().empty() ? fs::path() : config_folder() / "editor.ini"; }

void Editor::take_settings()
{
    settings_ = load_settings(settings_file());
    ImGui::LoadIniSettingsFromMemory(settings_.windows.data(), settings_.windows.size());
    panel_.folded = settings_.folded;
    panel_.locked = settings_.locked;
    show_panel_ = settings_.panel;
    show_history_ = settings_.history;
    leeway_.allowed = settings_.give_way;
    if (settings_.browser)
        browse(true);
    SDL_Rect room;
    if (settings_.width > 0 && settings_.height > 0 && SDL_GetDisplayUsableBounds(0, &room) == 0)
    {
        SDL_SetWindowSize(window_.sdl(), std::min(settings_.width, room.w), std::min(settings_.height, room.h));
        SDL_SetWindowPosition(window_.sdl(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED); // all of it is seen
    }
}

// Where something has changed. That it cannot be written is told once, and nobody loses work by it.
void Editor::keep_settings()
{
    const double now = double(SDL_GetTicks64()) * 1e-3;
    if (now < next_keep_ || settings_file().empty() || frames_ == 0)
        return;
    next_keep_ = now + 2.0;
    Settings current;
    SDL_GetWindowSize(window_.sdl(), &current.width, &current.height);
    current.panel = show_panel_;
    current.history = show_history_;
    current.give_way = leeway_.allowed;
    current.browser = browser_.shown;
    current.folded = panel_.folded;
    current.locked = panel_.locked;
    size_t bytes = 0;
    const char* text = ImGui::SaveIniSettingsToMemory(&bytes);
    current.windows = parse_settings(std::string(text, bytes)).windows;
    if (current == settings_)
        return;
    settings_ = current;
    try
    {
        save_settings(settings_file(), current);
    }
    catch (const std::exception& e)
    {
        if (!std::exchange(settings_told_, true) && message_.empty())
            say(fmt::format("how the window is arranged cannot be kept: {}", e.what()));
    }
}

} // namespace coif
