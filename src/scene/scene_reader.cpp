// Scenes from JSON. Every value that is looked at knows its place, so that an error can name it.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/material_presets.h>
#include <mirrorball/scene_file.h>

#include "core/nearest.h"
#include "io/file.h"
#include "scene/json_tree.h"
#include "scene/scene_fields.h"

namespace mirrorball {
namespace detail {
namespace {

constexpr std::uint64_t kLargestFile = 64u << 20;

std::string joined(const std::vector<std::string>& words) {
    return fmt::format("{}", fmt::join(words, ", "));
}

// `; did you mean "mirror"?` or the words there are.
std::string suggestion(std::string_view word, const std::vector<std::string>& words) {
    const std::string near = nearest(word, words);
    return near.empty() ? fmt::format("; there are: {}", joined(words))
                        : fmt::format("; did you mean \"{}\"?", near);
}

// A value and the way to it: "objects[2].material.mirror".
class Value {
  public:
    Value(const JsonDocument& document, const JsonNode& node, std::string path)
        : document_(&document),
          node_(&node),
          path_(std::move(path)) {}

    [[nodiscard]] const JsonNode& node() const { return *node_; }
    [[nodiscard]] bool is(JsonNode::Kind kind) const { return node_->kind == kind; }

    [[noreturn]] void fail(const std::string& what) const { fail_at(node_->position, what); }
    [[noreturn]] void fail_at(std::size_t position, const std::string& what) const {
        document_->fail(position, path_.empty() ? what : fmt::format("{}: {}", path_, what));
    }
    void expect(JsonNode::Kind kind, std::string_view what) const {
        if (!is(kind)) fail(fmt::format("{}; expected {}", quoted(*node_), what));
    }

    [[nodiscard]] double number(double least, double most) const {
        if (!is(JsonNode::Kind::number) || !(node_->number >= least && node_->number <= most)) {
            fail(fmt::format("{}; expected a number from {} to {}", quoted(*node_), least, most));
        }
        return node_->number;
    }
    [[nodiscard]] const std::string& text() const {
        expect(JsonNode::Kind::text, "text");
        return node_->text;
    }
    [[nodiscard]] Vec3d vector(double least, double most) const {
        if (!is(JsonNode::Kind::array) || node_->items.size() != 3) {
            fail(fmt::format("{}; expected [x, y, z]", quoted(*node_)));
        }
        return {item(0).number(least, most), item(1).number(least, most),
                item(2).number(least, most)};
    }
    [[nodiscard]] Vec3d one_or_three(double least, double most) const {
        if (is(JsonNode::Kind::array) && node_->items.size() == 3) return vector(least, most);
        if (!is(JsonNode::Kind::number)) {
            fail(fmt::format("{}; expected a number or an array of three", quoted(*node_)));
        }
        return Vec3d(number(least, most));
    }

    [[nodiscard]] Imath::V2d one_or_two(double least, double most) const {
        if (is(JsonNode::Kind::number)) return Imath::V2d(number(least, most));
        expect_pair("a number or an array of two");
        return {item(0).number(least, most), item(1).number(least, most)};
    }
    void expect_pair(std::string_view what) const {
        if (!is(JsonNode::Kind::array) || node_->items.size() != 2)
            fail(fmt::format("{}; expected {}", quoted(*node_), what));
    }

    [[nodiscard]] std::size_t size() const { return node_->items.size(); }
    [[nodiscard]] Value item(std::size_t i) const {
        return {*document_, node_->items[i], fmt::format("{}[{}]", path_, i)};
    }
    [[nodiscard]] Value member(std::size_t i) const {
        return {*document_, node_->items[i],
                path_.empty() ? node_->keys[i] : fmt::format("{}.{}", path_, node_->keys[i])};
    }

  private:
    const JsonDocument* document_;
    const JsonNode* node_;
    std::string path_;
};

// The members of an object; a visitor of scene_fields.h that sets what is there.
class Reader {
  public:
    explicit Reader(Value value) : value_(std::move(value)) {
        value_.expect(JsonNode::Kind::object, "an object, { }");
    }

    [[nodiscard]] const Value& value() const { return value_; }

    [[nodiscard]] std::optional<Value> find(const char* key) {
        known_.emplace_back(key);
        const std::vector<std::string>& keys = value_.node().keys;
        const auto found = std::find(keys.begin(), keys.end(), key);
        if (found == keys.end()) return std::nullopt;
        return value_.member(static_cast<std::size_t>(found - keys.begin()));
    }

    // All keys must have been asked for.
    void finish() const {
        const JsonNode& node = value_.node();
        for (std::size_t i = 0; i < node.keys.size(); ++i) {
            if (std::find(known_.begin(), known_.end(), node.keys[i]) != known_.end()) continue;
            value_.fail_at(node.key_positions[i],
                           fmt::format("no key is called \"{}\" here{}", node.keys[i],
                                       suggestion(node.keys[i], known_)));
        }
    }

    void number(const char* key, double& result, double least, double most) {
        if (const auto v = find(key)) result = v->number(least, most);
    }
    void degrees(const char* key, double& result, double least, double most) {
        if (const auto v = find(key)) result = v->number(least, most) * kPi / 180;
    }
    void whole(const char* key, int& result, int least, int most) {
        const auto v = find(key);
        if (!v) return;
        const double number = v->number(least, most);
        if (number != std::floor(number)) {
            v->fail(fmt::format("{}; expected a whole number from {} to {}", number, least, most));
        }
        result = static_cast<int>(number);
    }
    void flag(const char* key, bool& result) {
        const auto v = find(key);
        if (!v) return;
        v->expect(JsonNode::Kind::boolean, "true or false");
        result = v->node().boolean;
    }
    void text(const char* key, std::string& result) {
        if (const auto v = find(key)) result = v->text();
    }
    void vector(const char* key, Vec3d& result) {
        if (const auto v = find(key)) result = v->vector(-kFarthest, kFarthest);
    }
    void scale(const char* key, Vec3d& result) {
        const auto v = find(key);
        if (!v) return;
        result = v->one_or_three(-kFarthest, kFarthest);
        if (result.x == 0 || result.y == 0 || result.z == 0) v->fail("a scale of 0 leaves nothing");
    }
    void colour(const char* key, Vec3d& result, double least, double most) {
        if (const auto v = find(key)) result = v->one_or_three(least, most);
    }
    template <class T, class Parse, class Print>
    void spelled(const char* key, T& result, Parse&& parse, Print&& /*print*/) {
        const auto v = find(key);
        if (!v) return;
        try {
            result = parse(v->text());
        } catch (const Error& error) {
            if (error.code() != Errc::usage) throw;
            v->fail(error.what());
        }
    }
    // One number for both, or two.
    void pair(const char* key, Imath::V2d& result, double least, double most) {
        if (const auto v = find(key)) result = v->one_or_two(least, most);
    }
    void matrix(const char* key, Imath::M22d& result, double least, double most) {
        const auto v = find(key);
        if (!v) return;
        constexpr std::string_view kMatrix = "two rows of two numbers, [[a, b], [c, d]]";
        v->expect_pair(kMatrix);
        for (int i = 0; i < 2; ++i) {
            const Value row = v->item(static_cast<std::size_t>(i));
            row.expect_pair(kMatrix);
            for (int j = 0; j < 2; ++j)
                result[i][j] = row.item(static_cast<std::size_t>(j)).number(least, most);
        }
    }
    // Over what is there already, of a material that this one is like.
    void bump(const char* key, BumpMap& result) {
        const auto v = find(key);
        if (!v) return;
        Reader reader(*v);
        visit_bump(reader, result);
        reader.finish();
    }
    void floor(const char* key, std::optional<Floor>& result) {
        const auto v = find(key);
        if (!v) return;
        Reader reader(*v);
        if (!result) result.emplace();
        visit_floor(reader, *result);
        reader.finish();
    }
    void proxy(const char* key, Proxy& result);

  private:
    Value value_;
    std::vector<std::string> known_;
};

// An object with one of some keys, each of which stands for a kind: {"box": {...}}.
Value only_member(const Value& value, std::string_view what,
                  const std::vector<std::string>& kinds) {
    const JsonNode& node = value.node();
    if (!value.is(JsonNode::Kind::object) || node.keys.size() != 1) {
        value.fail(fmt::format("{}; expected {} of one kind, as {{ \"{}\": {{ }} }}; there are: {}",
                               quoted(node), what, kinds.front(), joined(kinds)));
    }
    if (std::find(kinds.begin(), kinds.end(), node.keys[0]) == kinds.end()) {
        value.fail_at(node.key_positions[0], fmt::format("\"{}\" is no kind of {}{}", node.keys[0],
                                                         what, suggestion(node.keys[0], kinds)));
    }
    return value.member(0);
}

void Reader::proxy(const char* key, Proxy& result) {
    const auto v = find(key);
    if (!v) return;
    Reader reader(only_member(*v, "proxy", {"box", "sphere"}));
    if (v->node().keys[0] == "box") {
        BoxProxy box;
        visit_box(reader, box);
        reader.finish();
        if (!(box.least.x < box.most.x && box.least.y < box.most.y && box.least.z < box.most.z)) {
            v->fail("the box is empty; expected each number of `least` below that of `most`");
        }
        result = box;
    } else {
        SphereProxy sphere;
        visit_sphere(reader, sphere);
        reader.finish();
        result = sphere;
    }
}

// Materials by name, each with what it takes over from the one it is like: those of the file, and
// the presets whose names it does not use itself.
class Materials {
  public:
    Materials() {
        for (const MaterialPreset& preset : material_presets()) {
            names_.push_back(preset.name);
            done_[preset.name] = preset.material;
        }
    }
    explicit Materials(const Value& value) : Materials() {
        value.expect(JsonNode::Kind::object, "an object of materials by name");
        for (std::size_t i = 0; i < value.size(); ++i) {
            const std::string& name = value.node().keys[i];
            names_.push_back(name);
            done_.erase(name);
            values_.emplace(name, value.member(i));
        }
        for (const auto& [name, of_file] : values_) done_[name] = made(name);
    }

    // Of an object: a name, or a material of its own.
    [[nodiscard]] Material operator()(const Value& value) const {
        if (value.is(JsonNode::Kind::text)) {
            check(value);
            return done_.at(value.text());
        }
        const std::optional<Value> base = like(value);
        return with_fields(base ? done_.at(base->text()) : Material{}, value);
    }

  private:
    void check(const Value& name) const {
        if (values_.count(name.text()) != 0 || done_.count(name.text()) != 0) return;
        name.fail(fmt::format("no material is called \"{}\"{}", name.text(),
                              suggestion(name.text(), names_)));
    }

    [[nodiscard]] std::optional<Value> like(const Value& value) const {
        std::optional<Value> base = Reader(value).find("like");
        if (base) check(*base);
        return base;
    }

    // Up the chain of likes to one that is done or like none, then down again.
    [[nodiscard]] Material made(const std::string& name) {
        std::vector<std::string> chain{name};
        std::set<std::string> met{name};
        while (done_.count(chain.back()) == 0) {
            const std::optional<Value> base = like(values_.at(chain.back()));
            if (!base) {
                chain.emplace_back();  // which is like a Material that nobody touched
                break;
            }
            if (!met.insert(base->text()).second) fail_circle(chain, *base);
            chain.push_back(base->text());
        }
        const std::string last = chain.back();
        Material material = done_.count(last) != 0 ? done_.at(last) : Material{};
        for (std::size_t i = chain.size() - 1; i-- > 0;) {
            material = with_fields(material, values_.at(chain[i]));
            done_[chain[i]] = material;
        }
        return material;
    }

    [[noreturn]] static void fail_circle(const std::vector<std::string>& chain, const Value& base) {
        const std::vector<std::string> circle(std::find(chain.begin(), chain.end(), base.text()),
                                              chain.end());
        base.fail(fmt::format("these materials are like each other in a circle: {} -> {}",
                              fmt::join(circle, " -> "), base.text()));
    }

    static Material with_fields(Material material, const Value& value) {
        Reader reader(value);
        (void)reader.find("like");
        visit_material(reader, material);
        reader.finish();
        const Lobe::Kind kind = material.lobe.kind;
        if (kind != Lobe::Kind::phong && kind != Lobe::Kind::blinn_phong &&
            kind != Lobe::Kind::ggx && kind != Lobe::Kind::charlie) {
            reader.find("lobe")->fail(
                fmt::format("a material's lobe is phong, blinn-phong, ggx or charlie, not {}",
                            to_string(material.lobe)));
        }
        return material;
    }

    std::vector<std::string> names_;
    std::map<std::string, Value> values_;
    std::map<std::string, Material> done_;
};

SceneObject read_object(const Value& value, const Materials& materials) {
    SceneObject object;
    Reader reader(value);
    reader.text("name", object.name);
    reader.text("mesh", object.mesh);
    if (const auto v = reader.find("transform")) {
        Reader transform(*v);
        visit_transform(transform, object.transform);
        transform.finish();
    }
    if (const auto v = reader.find("material")) object.material = materials(*v);
    if (const auto v = reader.find("dynamic")) {
        Reader dynamic(*v);
        visit_dynamic(dynamic, object.dynamic.emplace());
        dynamic.finish();
    }
    reader.finish();
    return object;
}

SceneLight read_light(const Value& value) {
    Reader reader(only_member(value, "light", {"point", "directional"}));
    if (value.node().keys[0] == "point") {
        ScenePointLight light;
        visit_point_light(reader, light);
        reader.finish();
        return light;
    }
    SceneDirectionalLight light;
    visit_directional_light(reader, light);
    reader.finish();
    if (light.direction == Vec3d(0)) value.fail("a direction of length 0 leads nowhere");
    return light;
}

void read_camera(const Value& value, Camera& camera) {
    Reader reader(value);
    visit_camera(reader, camera);
    reader.finish();
    if (camera.eye == camera.target) value.fail("eye and target are the same point");
    if (camera.up == Vec3d(0)) value.fail("an `up` of length 0 leads nowhere");
}

template <class Each>
void for_each_item(const std::optional<Value>& list, std::string_view what, Each&& each) {
    if (!list) return;
    list->expect(JsonNode::Kind::array, what);
    for (std::size_t i = 0; i < list->size(); ++i) each(list->item(i));
}

Scene read(const Value& root) {
    Scene scene;
    Reader reader(root);
    const std::optional<Value> named = reader.find("materials");
    const Materials materials = named ? Materials(*named) : Materials();
    for_each_item(reader.find("objects"), "an array of objects",
                  [&](const Value& v) { scene.objects.push_back(read_object(v, materials)); });
    if (const auto v = reader.find("environment")) {
        Reader environment(*v);
        visit_environment(environment, scene.environment);
        environment.finish();
    }
    for_each_item(reader.find("lights"), "an array of lights",
                  [&](const Value& v) { scene.lights.push_back(read_light(v)); });
    if (const auto v = reader.find("camera")) read_camera(*v, scene.camera);
    visit_picture(reader, scene);
    reader.finish();
    return scene;
}

}  // namespace
}  // namespace detail

Scene parse_scene(std::string_view text, std::string_view name_for_errors) {
    const detail::JsonDocument document{std::string(name_for_errors), text};
    return detail::read(detail::Value(document, document.root(), ""));
}

Scene read_scene(const std::filesystem::path& path) {
    detail::InputFile file(path);
    if (file.size() > detail::kLargestFile) {
        file.fail(fmt::format("{} bytes; scene files have at most {}", file.size(),
                              detail::kLargestFile));
    }
    std::string text(file.size(), '\0');
    file.read(std::as_writable_bytes(std::span<char>(text)));
    return parse_scene(text, path.string());
}

}  // namespace mirrorball
