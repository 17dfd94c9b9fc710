// Brushes in the view: what the mouse does with one, its ring on the scalp, and the window that they are chosen in.
#include "app/editor.h"
#include "app/panel_lists.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coif
{

static constexpr ImU32 kRing = IM_COL32(255, 200, 90, 230), kRingDark = IM_COL32(20, 16, 10, 160);

// Where the pixel (x, y) of A's picture meets the head, in the head's frame, m before head.scale.
std::optional<glm::vec3> Editor::on_scalp(double x, double y) const
{
    const std::optional<glm::dvec3> at = point_on_head(*simulation_, camera_, x, y, picture_width(), view_height_);
    if (!at)
        return std::nullopt;
    const Pose& head = simulation_->solver().head();
    return glm::vec3(glm::conjugate(head.turn) * (*at - head.origin) / double(style_.params.head_scale));
}

glm::dvec3 Editor::in_world(glm::vec3 on_head) const
{
    const Pose& head = simulation_->solver().head();
    return head.origin + head.turn * (glm::dvec3(on_head) * double(style_.params.head_scale));
}

// Takes the brush to a pixel: touches along the way, so that a quick stroke leaves no gaps.
void Editor::stroke(double x, double y, bool begins)
{
    const std::optional<glm::vec3> at = on_scalp(x, y);
    if (!at)
        return;
    if (begins || !stroke_.last)
    {
        stroke_.last = at;
        stroke_.rest = simulation_->rest_shapes();
        if (brush_.kind == BrushKind::COMB)
            return; // it has no way to go yet
    }
    const glm::vec3 from = *stroke_.last, way = *at - from;
    if (brush_.kind == BrushKind::COMB && glm::length(way) < 0.002f)
        return; // wait for more of a way
    const int touches = std::clamp(int(glm::length(way) / (0.35f * brush_.radius)) + 1, 1, 12);
    for (int i = 1; i <= touches; ++i)
        stroke_.changed |= apply_brush(style_, simulation_->assets().scalp, stroke_.rest, brush_,
                                       {from + way * (float(i) / float(touches)), way / float(touches)});
    stroke_.last = at;
}

// Once a frame, however many events there were; and where hair takes long to grow and drape, at most a third of the
// time, so that the hand can still be followed.
void Editor::apply_strokes()
{
    if (!stroke_.changed)
        return;
    const double began = double(SDL_GetTicks64()) * 1e-3;
    if (held_.what != Grab::NONE && began < stroke_.next)
    {
        redraw_ = kRedraw; // comes back to it
        return;
    }
    stroke_.changed = false;
    apply();
    const double ended = double(SDL_GetTicks64()) * 1e-3;
    stroke_.next = ended + 2.0 * (ended - began);
}

void Editor::end_stroke()
{
    const Grab::What what = std::exchange(held_.what, Grab::NONE);
    apply_strokes();
    if (what == Grab::BRUSH && brush_.kind == BrushKind::REGION)
    {
        const auto region = std::ranges::find(style_.host.regions, brush_.region, &Region::name);
        if (note_edit(history_, style_, saved_, fmt::format("painted {}", brush_.region)) &&
            region != style_.host.regions.end() && region->settings.empty())
            say(fmt::format("{} changes nothing yet: set what it does in the panel, under region", brush_.region));
    }
    else if (what == Grab::BRUSH)
        note_edit(history_, style_, saved_, fmt::format("brush: {}", brush_name(brush_.kind)));
    else if (what == Grab::CUT)
        note_edit(history_, style_, saved_, "cut straight");
    else if (what == Grab::COLLIDER)
        note_edit(history_, style_, saved_, fmt::format("moved collider {}", held_.collider + 1));
    else if (what == Grab::LIGHT)
        note_edit(history_, style_, saved_, "turned a light");
    else if (what == Grab::TIE)
        note_edit(history_, style_, saved_, fmt::format("moved tie {}", style_.host.ties.at(held_.tie).name));
}

// Cuts all that hangs below a line across the view.
void Editor::cut_along(double x0, double y0, double x1, double y1)
{
    const int width = picture_width();
    const Ray a = ray_through(camera_, x0, y0, width, view_height_),
              b = ray_through(camera_, x1, y1, width, view_height_);
    const glm::dvec3 across = glm::cross(a.direction, b.direction);
    if (!(glm::length(across) > 1e-4))
        return;
    const glm::dvec3 normal = glm::normalize(across);
    const Ray below = ray_through(camera_, 0.5 * (x0 + x1), std::max(y0, y1) + 10.0, width, view_height_);
    const glm::dvec3 down = glm::dot(normal, below.direction) < 0.0 ? -normal : normal;
    const Pose& head = simulation_->solver().head();
    const double scale = double(style_.params.head_scale);
    const glm::dvec3 n = glm::conjugate(head.turn) * down;
    const glm::dvec3 through = glm::conjugate(head.turn) * (a.origin - head.origin) / scale;
    // As it hangs now: that is what one sees and cuts.
    if (cut_at_plane(style_, simulation_->assets().scalp, simulation_->shapes(), glm::vec3(n),
                     float(glm::dot(n, through))))
        apply();
    else
        say("nothing reaches below that line");
}

void Editor::freeze()
{
    guarded(
        [&]
        {
            style_.host.groom_rest = {"", std::make_shared<const StrandShapes>(simulation_->shapes())};
            apply();
            note_edit(history_, style_, saved_, "froze the hair as it is");
            say("this is the hair's rest shape now; saving keeps it beside the style");
        });
}

// Takes the rest shape away: hair falls from where it is and comes to rest.
void Editor::settle_hair()
{
    if (!style_.host.groom_rest.shapes)
        return say("the hair has no rest shape of its own: it falls as it is");
    style_.host.groom_rest = {};
    apply();
    note_edit(history_, style_, saved_, "let the hair settle");
    paused_ = false;
}

static ImVec2 on_screen(const std::optional<glm::dvec2>& p)
{
    return p ? ImVec2(float(p->x), float(p->y)) : ImVec2(-1e4f, -1e4f);
}

// The brush's reach, lying on the scalp; and the line of a cut.
void Editor::draw_ring()
{
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (held_.what == Grab::CUT)
    {
        draw.AddLine(ImVec2(float(held_.x), float(held_.y)), mouse, kRingDark, 4.0f);
        draw.AddLine(ImVec2(float(held_.x), float(held_.y)), mouse, kRing, 2.0f);
        return;
    }
    if (cutting_ || ImGui::GetIO().WantCaptureMouse)
        return;
    const std::optional<glm::vec3> at = on_scalp(double(mouse.x), double(mouse.y));
    const Scalp& scalp = simulation_->assets().scalp;
    if (!at || std::ranges::none_of(scalp.positions,
                                    [&](const glm::vec3& root) { return glm::distance(root, *at) < brush_.radius; }))
        return; // nothing grows there
    for (const float side : {1.0f, -1.0f})
    {
        if (side < 0.0f && !brush_.mirror)
            break;
        const glm::vec3 middle = *at * glm::vec3(side, 1.0f, 1.0f);
        const glm::vec3 n = glm::normalize(middle - scalp.center + glm::vec3(0.0f, 1e-6f, 0.0f));
        const glm::vec3 u =
            glm::normalize(glm::cross(n, std::abs(n.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0)));
        const glm::vec3 v = glm::cross(n, u);
        std::vector<ImVec2> ring;
        for (int i = 0; i < 48; ++i)
        {
            const float angle = float(i) / 48.0f * 2.0f * std::numbers::pi_v<float>;
            const glm::vec3 p = middle + brush_.radius * (std::cos(angle) * u + std::sin(angle) * v);
            ring.push_back(
                on_screen(project(camera_, surface_below(*simulation_, in_world(p)), picture_width(), view_height_)));
        }
        draw.AddPolyline(ring.data(), int(ring.size()), kRingDark, ImDrawFlags_Closed, 4.0f);
        draw.AddPolyline(ring.data(), int(ring.size()), kRing, ImDrawFlags_Closed, 1.8f);
    }
}

// What the brush aims at.
void Editor::draw_brush_aim()
{
    const HairParams usual;
    const auto slider = [&](const char* name, float& value, const char* path, const char* format)
    {
        const ParamInfo& info = *find_param(path);
        ImGui::SliderFloat(name, &value, info.min, info.max, format,
                           info.max > 40.0f * std::max(value, 0.01f) ? ImGuiSliderFlags_Logarithmic : 0);
    };
    switch (brush_.kind)
    {
    case BrushKind::LENGTH:
        slider("length", brush_.length, "strand.length", "%.3f m");
        break;
    case BrushKind::LIFT:
        slider("lift", brush_.lift, "root.lift", "%.0f deg");
        break;
    case BrushKind::WAVE:
        slider("height", brush_.wave, "wave.normal_amplitude", "%.4f m");
        break;
    case BrushKind::DENSITY:
        slider("density", brush_.density, "interpolation.density", "%.2f");
        break;
    case BrushKind::COLOR:
        ImGui::ColorEdit3("color", &brush_.color.x);
        ImGui::Combo("of", &brush_.color_of, "roots\0tips\0both\0");
        break;
    case BrushKind::REGION:
        draw_region_aim();
        break;
    case BrushKind::COMB:
    case BrushKind::SMOOTH:
    case BrushKind::ERASE:
        break;
    }
}

// Which region is painted, and how.
void Editor::draw_region_aim()
{
    const std::vector<Region>& regions = style_.host.regions;
    const auto chosen = std::ranges::find(regions, brush_.region, &Region::name);
    if (ImGui::BeginCombo("region", chosen == regions.end() ? "a new one" : chosen->name.c_str()))
    {
        for (const Region& region : regions)
            if (ImGui::Selectable(region.name.c_str(), region.name == brush_.region))
                brush_.region = region.name;
        if (ImGui::Selectable("a new one", chosen == regions.end()))
            brush_.region.clear();
        ImGui::EndCombo();
    }
    brush_places_["region of"] = last_widget();
    explain(chosen != regions.end() && !is_painted_only(*chosen)
                ? "A rule tells this region: the first stroke makes a painted map of it."
                : "The region that is painted. alt-click on the head takes the one that is there.");
    ImGui::SliderFloat("weight", &brush_.weight, 0.0f, 1.0f, "%.2f", ImGuiSliderFlags_AlwaysClamp);
    brush_places_["weight"] = last_widget();
    explain("1 makes roots a part of it, 0 takes them out.");
    const std::vector<std::string> views = param_labels(*find_param("render.colors"));
    const int of_regions = int(std::ranges::find(views, "region") - views.begin());
    bool shown = style_.params.render_colors == of_regions;
    if (ImGui::Checkbox("show regions on the hair", &shown))
    {
        style_.params.render_colors = shown ? of_regions : 0;
        apply();
    }
    brush_places_["show regions"] = last_widget();
}

void Editor::draw_brushes()
{
    ImGui::SetNextWindowPos(ImVec2(8.0f, float(view_height_) - kMessageRoom), ImGuiCond_FirstUseEver,
                            ImVec2(0.0f, 1.0f));
    ImGui::SetNextWindowBgAlpha(0.85f);
    if (ImGui::Begin("shape", &brushing_, ImGuiWindowFlags_AlwaysAutoResize))
    {
        keep_in_view(float(view_width_), float(view_height_) - kMessageRoom); // each brush has widgets of its own
        for (int i = 0; i < kBrushKinds; ++i)
        {
            const BrushKind kind = BrushKind(i);
            if (i % 3)
                ImGui::SameLine();
            const bool chosen = !cutting_ && brush_.kind == kind;
            if (chosen)
                ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
            if (ImGui::Button(brush_name(kind), ImVec2(86.0f, 0.0f)))
            {
                brush_.kind = kind;
                cutting_ = false;
            }
            if (chosen)
                ImGui::PopStyleColor();
            brush_places_[brush_name(kind)] = last_widget();
            explain(brush_help(kind));
        }
        ImGui::PushItemWidth(170.0f);
        ImGui::SliderFloat("radius", &brush_.radius, 0.004f, 0.15f, "%.3f m", ImGuiSliderFlags_Logarithmic);
        explain("Of the ring on the scalp; [ and ] change it.");
        ImGui::SliderFloat("strength", &brush_.strength, 0.02f, 1.0f, "%.2f");
        explain("Share of the way to its aim that one touch goes.");
        ImGui::SliderFloat("fall-off", &brush_.falloff, 0.0f, 1.0f, "%.2f");
        explain("0 works as strongly up to the ring, 1 fades from the middle on.");
        draw_brush_aim();
        ImGui::PopItemWidth();
        ImGui::Checkbox("mirror left and right", &brush_.mirror);
        explain("What is done on one half of the head is done on the other too.");
        ImGui::TextDisabled("alt-click picks a value; [ and ] change the radius");
        ImGui::Separator();
        if (ImGui::Button(cutting_ ? "cutting..." : "cut straight"))
            cutting_ = !cutting_;
        brush_places_["cut"] = last_widget();
        explain("Draw a line across the view: what hangs below it is cut.");
        ImGui::SameLine();
        if (ImGui::Button("freeze"))
            freeze();
        brush_places_["freeze"] = last_widget();
        explain("What is on screen becomes the shape that the hair rests in.");
        ImGui::SameLine();
        if (ImGui::Button("settle"))
            settle_hair();
        brush_places_["settle"] = last_widget();
        explain("Takes the rest shape away and lets the hair fall and come to rest.");
        draw_variants();
    }
    ImGui::End();
    if (brushing_)
        draw_ring();
}

// Named snapshots: which is on, and a new one.
void Editor::draw_variants()
{
    ImGui::Separator();
    const auto variants = current_variants(style_);
    ImGui::SetNextItemWidth(110.0f);
    std::optional<std::string> wanted;
    if (ImGui::BeginCombo("variant", style_.variant.empty() ? "none" : style_.variant.c_str()))
    {
        if (ImGui::Selectable("none", style_.variant.empty()))
            wanted = "";
        for (const auto& [name, settings] : variants)
            if (ImGui::Selectable(name.c_str(), name == style_.variant))
                wanted = name;
        ImGui::EndCombo();
    }
    if (wanted)
        guarded(
            [&]
            {
                switch_variant(style_, *wanted);
                apply();
                note_edit(history_, style_, saved_, wanted->empty() ? "no variant" : "variant " + *wanted);
            });
    explain("A snapshot to go back to. While it is on, changes are its own.");
    ImGui::SetNextItemWidth(110.0f);
    ImGui::InputTextWithHint("##variant", "name", variant_name_, sizeof variant_name_);
    ImGui::SameLine();
    if (ImGui::Button("snapshot") && *variant_name_)
        guarded(
            [&]
            {
                take_variant(style_, variant_name_);
                apply();
                note_edit(history_, style_, saved_, std::string("snapshot ") + variant_name_);
            });
    explain("Keeps all sliders as they are under this name, in the style.");
}

// Takes the left button where a brush or the scissors are out. Returns whether it did.
bool Editor::press_brush(double x, double y)
{
    if (!brushing_ || comparing_)
        return false;
    if (cutting_)
    {
        held_ = {};
        held_.what = Grab::CUT;
        held_.x = x;
        held_.y = y;
        return true;
    }
    const std::optional<glm::vec3> at = on_scalp(x, y);
    if (!at)
        return false;
    if (SDL_GetModState() & KMOD_ALT)
    {
        pick_value(brush_, style_, simulation_->assets().scalp, *at);
        return true;
    }
    if (brush_.kind == BrushKind::REGION &&
        std::ranges::find(style_.host.regions, brush_.region, &Region::name) == style_.host.regions.end())
        brush_.region = unused_region(style_.host.regions);
    held_ = {};
    held_.what = Grab::BRUSH;
    stroke_.last.reset();
    stroke(x, y, true);
    return true;
}

} // namespace coif
