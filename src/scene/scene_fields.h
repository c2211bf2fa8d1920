// The members of a scene as its file has them: names, ranges, spelling. Stated once, for reading
// and for writing: visit(visitor, part) shows a visitor each member.
#pragma once

#include <mirrorball/fresnel.h>
#include <mirrorball/lobe.h>
#include <mirrorball/scene.h>

namespace mirrorball::detail {

inline constexpr double kFarthest = 1e9;  ///< of positions, in metres
inline constexpr double kBrightestLight = 1e12;

// The visitor's members: `number`, `whole`, `flag`, `text`, `vector` (three numbers), `scale` (the
// same or one number for all, none 0), `colour` (three numbers or one), `degrees`, `spelled` (text
// with a parser and a printer), `pair` (two numbers), `matrix` (two rows of two), and members that
// are objects themselves: `bump`, `floor`, `proxy`.

template <class V, class B>
void visit_bump(V& v, B& b) {
    v.text("source", b.source);
    v.spelled(
        "kind", b.kind, [](std::string_view kind) { return std::optional(parse_bump_kind(kind)); },
        [](const std::optional<BumpKind>& kind) { return kind ? name(*kind) : ""; });
    v.spelled("green", b.green, parse_green, [](Green g) { return name(g); });
    v.spelled("wrap", b.wrap, parse_wrap, [](Wrap w) { return name(w); });
    v.number("height_scale", b.height_scale, -1e6, 1e6);
    v.number("width", b.width, 0, 1e6);
    v.whole("size", b.size, 1, 4096);
    v.pair("repeat", b.repeat, -1e4, 1e4);
    v.pair("offset", b.offset, -1e4, 1e4);
    v.pair("drift", b.drift, -1e4, 1e4);
    v.number("strength", b.strength, -100, 100);
    v.spelled("form", b.form, parse_bump_form, [](BumpForm f) { return name(f); });
    v.spelled("filter", b.filter, parse_bump_filter, [](BumpFilter f) { return name(f); });
    v.number("relief", b.relief, 0, 1);
    v.flag("horizon", b.horizon);
    v.matrix("matrix", b.matrix, -100, 100);
    v.degrees("matrix_turn_degrees", b.matrix_turn, -36000, 36000);
    v.number("luminance_scale", b.luminance_scale, -100, 100);
    v.number("luminance_offset", b.luminance_offset, -100, 100);
}

template <class V, class F>
void visit_floor(V& v, F& floor) {
    v.number("height", floor.height, -kFarthest, kFarthest);
    v.colour("color", floor.color, 0, 1);
    v.text("color_map", floor.color_map);
    v.number("color_width", floor.color_width, 1e-6, 1e6);
    v.colour("absorption", floor.absorption, 0, 1000);
}

template <class V, class M>
void visit_material(V& v, M& m) {
    v.colour("base_color", m.base_color, 0, 1);
    v.text("base_color_map", m.base_color_map);
    v.number("mirror", m.mirror, 0, 1);
    v.number("glossy", m.glossy, 0, 1);
    v.number("diffuse", m.diffuse, 0, 1);
    v.number("transmission", m.transmission, 0, 1);
    v.number("emission", m.emission, 0, kBrightestLight);
    v.spelled("lobe", m.lobe, parse_lobe, [](const Lobe& l) { return to_string(l); });
    v.spelled("fresnel", m.fresnel, parse_fresnel, [](const Fresnel& f) { return to_string(f); });
    v.spelled("coupling", m.coupling, parse_coupling, [](Coupling c) { return name(c); });
    v.number("index", m.index, 0.01, 100);
    v.floor("floor", m.floor);
    v.bump("bump", m.bump);
}

template <class V, class T>
void visit_turn(V& v, T& t) {
    v.degrees("yaw_degrees", t.yaw, -36000, 36000);
    v.degrees("pitch_degrees", t.pitch, -36000, 36000);
    v.degrees("roll_degrees", t.roll, -36000, 36000);
}

template <class V, class T>
void visit_transform(V& v, T& t) {
    v.vector("position", t.position);
    visit_turn(v, t);
    v.scale("scale", t.scale);
}

template <class V, class D>
void visit_dynamic(V& v, D& d) {
    v.whole("size", d.size, 16, 4096);
    v.whole("faces_per_frame", d.faces_per_frame, 1, 6);
    v.whole("bounces", d.bounces, 1, 8);
    v.spelled("drawing", d.drawing, parse_face_drawing, [](FaceDrawing f) { return name(f); });
}

template <class V, class B>
void visit_box(V& v, B& box) {
    v.vector("least", box.least);
    v.vector("most", box.most);
}

template <class V, class S>
void visit_sphere(V& v, S& sphere) {
    v.vector("centre", sphere.centre);
    v.number("radius", sphere.radius, 1e-6, kFarthest);
}

template <class V, class L>
void visit_point_light(V& v, L& light) {
    v.vector("position", light.position);
    v.colour("intensity", light.intensity, 0, kBrightestLight);
    v.degrees("turn_degrees", light.turn, -36000, 36000);
}

template <class V, class L>
void visit_directional_light(V& v, L& light) {
    v.vector("direction", light.direction);
    v.colour("normal_irradiance", light.normal_irradiance, 0, kBrightestLight);
    v.degrees("turn_degrees", light.turn, -36000, 36000);
}

template <class V, class E>
void visit_environment(V& v, E& e) {
    v.text("source", e.source);
    visit_turn(v, e);
    v.number("intensity", e.intensity, 0, 1e6);
    v.flag("background", e.background);
    v.colour("background_color", e.background_color, 0, kBrightestLight);
    v.proxy("proxy", e.proxy);
    v.vector("captured_at", e.captured_at);
}

template <class V, class C>
void visit_camera(V& v, C& camera) {
    v.vector("eye", camera.eye);
    v.vector("target", camera.target);
    v.vector("up", camera.up);
    v.degrees("field_of_view_degrees", camera.field_of_view, 0.1, 179);
}

template <class V, class S>
void visit_picture(V& v, S& scene) {
    v.spelled("method", scene.method, parse_method, [](Method m) { return name(m); });
    v.whole("map_size", scene.map_size, 0, 16384);
    v.number("exposure", scene.exposure, 0, 1e12);
    v.spelled("tone_map", scene.tone_map, parse_tone_map, [](ToneMap t) { return name(t); });
    v.number("time", scene.time, -1e6, 1e6);
}

}  // namespace mirrorball::detail
