// glTF 2.0, parsed by tinygltf.
//
// The parser trusts a file in ways that this reader must not: it recurses as deep as extras nest,
// opens pictures, and reads whole files before it compares their size. So the JSON is taken apart
// first: limited in depth, stripped of all that is not geometry, and its buffers replaced by names
// of ours, which the parser then asks for through its file callbacks. A .glb's second chunk is
// such a buffer too. What accessors say is checked here, before a byte is read by them.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <ImathMatrix.h>
#include <ImathQuat.h>
#include <fmt/format.h>
#include <mirrorball/error.h>
#include <tiny_gltf.h>
#include <nlohmann/json.hpp>

#include "readers.h"
#include "tangents.h"

namespace mirrorball::detail {
namespace {

using nlohmann::json;
using Bytes = std::vector<std::byte>;

// Messages of parsers quote the file, which may be all of it.
constexpr std::size_t kMostQuoted = 160;

// The file's parts -------------------------------------------------------------------------------

struct Parts {
    Bytes bytes;
    std::span<const std::byte> text, binary;
};

std::uint32_t word_at(const Bytes& bytes, std::size_t offset) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, sizeof(word));
    return word;
}

// A .glb: 12 bytes of header, then chunks of length, type and content: one of JSON, and perhaps one
// of binary data.
void find_chunks(const InputFile& file, Parts& parts) {
    constexpr std::uint32_t kJson = 0x4E4F534A, kBinary = 0x004E4942;
    constexpr std::size_t kHeader = 12, kChunkHeader = 8;
    const Bytes& bytes = parts.bytes;
    if (bytes.size() < kHeader + kChunkHeader)
        file.fail(fmt::format("a .glb of {} bytes is truncated", bytes.size()));
    const std::uint32_t version = word_at(bytes, 4), length = word_at(bytes, 8);
    if (version != 2) file.fail(fmt::format("a .glb of version {} (expected 2)", version));
    if (length > bytes.size() || length < kHeader + kChunkHeader)
        file.fail(fmt::format("is truncated: its header says {} bytes, and it has {}", length,
                              bytes.size()));

    std::size_t at = kHeader;
    for (int chunk = 0; chunk < 2 && length - at >= kChunkHeader; ++chunk) {
        const std::uint32_t size = word_at(bytes, at), type = word_at(bytes, at + 4);
        at += kChunkHeader;
        if (size > length - at)
            file.fail(fmt::format("chunk {} of {} bytes reaches over the end", chunk, size));
        const std::span<const std::byte> content(bytes.data() + at, size);
        if (chunk == 0 && type != kJson) file.fail("its first chunk is not JSON");
        if (chunk == 0) parts.text = content;
        if (chunk == 1 && type == kBinary) parts.binary = content;
        at += size;
    }
}

Parts read_parts(InputFile& file) {
    Parts parts;
    parts.bytes.resize(file.size());
    file.read(parts.bytes);
    if (parts.bytes.size() >= 4 && std::memcmp(parts.bytes.data(), "glTF", 4) == 0)
        find_chunks(file, parts);
    else
        parts.text = parts.bytes;
    return parts;
}

// The JSON ---------------------------------------------------------------------------------------

// Walks over a text without keeping it: how deep does it nest, and how many values has it?
class Survey : public nlohmann::json_sax<json> {
  public:
    static constexpr int kMostDepth = 64;

    [[nodiscard]] std::uint64_t values() const { return values_; }
    [[nodiscard]] bool too_deep() const { return depth_ > kMostDepth; }
    [[nodiscard]] const std::string& error() const { return error_; }

    bool null() override { return count(); }
    bool boolean(bool) override { return count(); }
    bool number_integer(number_integer_t) override { return count(); }
    bool number_unsigned(number_unsigned_t) override { return count(); }
    bool number_float(number_float_t, const string_t&) override { return count(); }
    bool string(string_t&) override { return count(); }
    bool binary(binary_t&) override { return count(); }
    bool key(string_t&) override { return count(); }
    bool start_object(std::size_t) override { return enter(); }
    bool end_object() override { return leave(); }
    bool start_array(std::size_t) override { return enter(); }
    bool end_array() override { return leave(); }
    bool parse_error(std::size_t, const std::string&, const json::exception& error) override {
        error_ = error.what();
        return false;
    }

  private:
    bool count() {
        ++values_;
        return true;
    }
    bool enter() {
        ++depth_;
        return count() && !too_deep();
    }
    bool leave() {
        --depth_;
        return true;
    }

    std::uint64_t values_ = 0;
    int depth_ = 0;
    std::string error_;
};

json parse_text(const InputFile& file, std::span<const std::byte> text,
                std::uint64_t memory_limit) {
    const char* begin = reinterpret_cast<const char*>(text.data());
    const char* end = begin + text.size();
    if (text.size() > std::numeric_limits<std::int32_t>::max())
        file.fail(fmt::format("its JSON has {} bytes (expected less than 2 GiB)", text.size()));

    Survey survey;
    if (!json::sax_parse(begin, end, &survey)) {
        if (survey.too_deep())
            file.fail(fmt::format("its JSON nests too deeply (expected at most {} levels)",
                                  Survey::kMostDepth));
        file.fail(fmt::format("is not glTF: {}", survey.error().substr(0, kMostQuoted)));
    }
    // The text, two trees with their strings, and what goes from one to the other.
    constexpr double kPerValue = 2 * 48, kPerByte = 5;
    check_memory(file,
                 kPerValue * static_cast<double>(survey.values()) +
                     kPerByte * static_cast<double>(text.size()),
                 memory_limit);
    json document = json::parse(begin, end);
    if (!document.is_object()) file.fail("is not glTF: an object was expected");
    return document;
}

void check_is_supported(const InputFile& file, const json& document) {
    const auto asset = document.find("asset");
    const bool has_version = asset != document.end() && asset->is_object() &&
                             asset->contains("version") && (*asset)["version"].is_string();
    if (!has_version) file.fail("is not glTF: it does not say its version");
    const std::string version = (*asset)["version"];
    if (version.substr(0, 2) != "2.")
        file.fail(fmt::format("is glTF {} (expected 2.0)", version.substr(0, kMostQuoted)));

    // Required extensions that leave geometry as it is, or as it is read here.
    constexpr std::string_view kHarmless[] = {"KHR_materials_", "KHR_texture_", "EXT_texture_",
                                              "KHR_lights_punctual", "KHR_mesh_quantization"};
    const auto required = document.find("extensionsRequired");
    if (required == document.end() || !required->is_array()) return;
    for (const json& entry : *required) {
        const std::string name = entry.is_string() ? entry.get<std::string>() : entry.dump();
        const bool harmless =
            std::any_of(std::begin(kHarmless), std::end(kHarmless),
                        [&](std::string_view prefix) { return name.starts_with(prefix); });
        if (!harmless)
            file.fail(
                fmt::format("requires the extension {}, which is not supported (save it "
                            "without compression)",
                            name.substr(0, kMostQuoted)));
    }
}

// What the parser is given: geometry and no more.
json only_geometry(json& document) {
    json result = json::object();
    for (const char* section :
         {"asset", "buffers", "bufferViews", "accessors", "meshes", "nodes", "scenes", "scene"}) {
        const auto found = document.find(section);
        if (found == document.end()) continue;
        json& kept = result[section] = std::move(*found);
        if (!kept.is_array()) continue;
        for (json& entry : kept) {
            if (!entry.is_object()) continue;
            for (const char* passed_over :
                 {"extras", "extensions", "name", "weights", "min", "max"})
                entry.erase(passed_over);
            if (!entry.contains("primitives") || !entry["primitives"].is_array()) continue;
            for (json& primitive : entry["primitives"]) {
                if (!primitive.is_object()) continue;
                for (const char* passed_over : {"extras", "extensions", "targets"})
                    primitive.erase(passed_over);
            }
        }
    }
    return result;
}

// Buffers ----------------------------------------------------------------------------------------

// Serves the parser's requests for files. Problems are kept and thrown when the parser has
// returned: it has no way to hand on what they say.
class BufferSource {
  public:
    BufferSource(const InputFile& file, std::span<const std::byte> binary,
                 std::uint64_t memory_limit)
        : file_(file),
          binary_(binary),
          memory_limit_(memory_limit) {}

    // Replaces what is not a data URI by a name of ours.
    void take_over(json& geometry) {
        const auto buffers = geometry.find("buffers");
        if (buffers == geometry.end() || !buffers->is_array()) return;
        for (std::size_t i = 0; i < buffers->size(); ++i) {
            json& buffer = (*buffers)[i];
            const bool has_length = buffer.is_object() && buffer.contains("byteLength") &&
                                    buffer["byteLength"].is_number_unsigned();
            if (!has_length || buffer["byteLength"] == 0)
                file_.fail(fmt::format("buffer {} has no byteLength (expected 1 or more)", i));
            const bool has_uri = buffer.contains("uri");
            if (has_uri && !buffer["uri"].is_string())
                file_.fail(fmt::format("buffer {}: its uri is not a string", i));
            const std::string uri = has_uri ? buffer["uri"].get<std::string>() : "";
            wanted_.push_back({uri, buffer["byteLength"].get<std::uint64_t>()});
            if (!uri.starts_with("data:")) buffer["uri"] = fmt::format("buffer{}", i);
        }
    }

    bool serve(const std::string& name, std::vector<unsigned char>& out) {
        try {
            constexpr std::size_t kPrefix = std::string_view("buffer").size();
            load(std::stoul(name.substr(kPrefix)), out);
            return true;
        } catch (const Error& error) {
            problem_ = error;
            return false;
        }
    }

    void throw_problem() const {
        if (problem_) throw *problem_;
    }

  private:
    struct Wanted {
        std::string uri;
        std::uint64_t length;
    };

    void load(std::size_t index, std::vector<unsigned char>& out) {
        const auto& [uri, length] = wanted_.at(index);
        if (uri.empty()) {
            if (index != 0 || binary_.empty())
                file_.fail(
                    fmt::format("buffer {} has no uri, and there is no binary chunk", index));
            if (binary_.size() < length)
                file_.fail(fmt::format("its binary chunk has {} bytes (expected {})",
                                       binary_.size(), length));
            out.resize(length);
            std::memcpy(out.data(), binary_.data(), length);
            return;
        }
        loaded_ += length;
        check_memory(file_, 2.0 * static_cast<double>(loaded_), memory_limit_);
        try {
            load_file(index, out);
        } catch (const Error& error) {
            file_.fail(fmt::format("buffer {}: {}", index, error.what()));
        }
    }

    void load_file(std::size_t index, std::vector<unsigned char>& out) {
        const auto& [uri, length] = wanted_.at(index);
        InputFile other(std::filesystem::path(file_.name()).parent_path() / decoded(uri));
        if (other.size() < length)
            other.fail(fmt::format("has {} bytes (expected {})", other.size(), length));
        out.resize(length);
        other.read(std::as_writable_bytes(std::span<unsigned char>(out)));
    }

    // %20 and the like.
    static std::string decoded(const std::string& uri) {
        std::string result;
        for (std::size_t i = 0; i < uri.size(); ++i) {
            const bool escaped = uri[i] == '%' && i + 2 < uri.size() &&
                                 std::isxdigit(byte(uri[i + 1])) && std::isxdigit(byte(uri[i + 2]));
            if (escaped) {
                result += static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16));
                i += 2;
            } else {
                result += uri[i];
            }
        }
        return result;
    }
    static unsigned char byte(char c) { return static_cast<unsigned char>(c); }

    const InputFile& file_;
    std::span<const std::byte> binary_;
    std::uint64_t memory_limit_, loaded_ = 0;
    std::vector<Wanted> wanted_;
    std::optional<Error> problem_;
};

tinygltf::FsCallbacks callbacks_to(BufferSource& source) {
    tinygltf::FsCallbacks callbacks{};
    callbacks.FileExists = [](const std::string&, void*) { return true; };
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>* out, std::string*,
                                 const std::string& name, void* to) {
        return static_cast<BufferSource*>(to)->serve(name, *out);
    };
    callbacks.WriteWholeFile = [](std::string*, const std::string&,
                                  const std::vector<unsigned char>&, void*) { return false; };
    callbacks.user_data = &source;
    return callbacks;
}

tinygltf::Model parse(const InputFile& file, json& geometry, BufferSource& source) {
    source.take_over(geometry);
    const std::string text = geometry.dump(-1, ' ', false, json::error_handler_t::replace);
    geometry = nullptr;

    tinygltf::TinyGLTF parser;
    parser.SetFsCallbacks(callbacks_to(source));
    parser.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int,
                             const unsigned char*, int, void*) { return true; },
                          nullptr);
    tinygltf::Model model;
    std::string error, warning;
    bool parsed = false;
    try {
        parsed = parser.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                            static_cast<unsigned>(text.size()), "");
    } catch (const std::exception& exception) {
        error = exception.what();
    }
    source.throw_problem();
    if (!parsed) {
        const std::size_t line = std::min(error.find('\n'), kMostQuoted);
        file.fail(fmt::format("cannot be read as glTF ({})", error.substr(0, line)));
    }
    return model;
}

// Accessors --------------------------------------------------------------------------------------

// An accessor whose every element lies within its buffer.
class Elements {
  public:
    Elements(const InputFile& file, const tinygltf::Model& model, int index, int type,
             const char* what) {
        const auto fail = [&](const std::string& found) {
            file.fail(fmt::format("accessor {} ({}): {}", index, what, found));
        };
        if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size())
            fail(fmt::format("is not there (the file has {})", model.accessors.size()));
        const tinygltf::Accessor& accessor = model.accessors[index];
        if (accessor.sparse.isSparse) fail("is sparse, which is not supported");
        if (accessor.type != type)
            fail(fmt::format("has {} components (expected {})",
                             tinygltf::GetNumComponentsInType(accessor.type),
                             tinygltf::GetNumComponentsInType(type)));
        const int component_size = tinygltf::GetComponentSizeInBytes(accessor.componentType);
        if (component_size <= 0 || accessor.componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE)
            fail(fmt::format("has components of type {}", accessor.componentType));
        if (accessor.bufferView < 0 ||
            static_cast<std::size_t>(accessor.bufferView) >= model.bufferViews.size())
            fail("has no buffer view");
        const tinygltf::BufferView& view = model.bufferViews[accessor.bufferView];
        if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size())
            fail("has no buffer");
        const std::vector<unsigned char>& data = model.buffers[view.buffer].data;
        if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
            fail(fmt::format("its view of {} bytes from {} reaches over the end of a buffer of {}",
                             view.byteLength, view.byteOffset, data.size()));

        component_type_ = accessor.componentType;
        component_size_ = static_cast<std::size_t>(component_size);
        normalized_ = accessor.normalized;
        count_ = accessor.count;
        const std::size_t size = component_size_ * tinygltf::GetNumComponentsInType(type);
        stride_ = view.byteStride != 0 ? view.byteStride : size;
        if (stride_ < size) fail(fmt::format("elements of {} bytes are {} apart", size, stride_));
        // The last element need not be followed by a whole stride.
        const bool fits =
            accessor.byteOffset <= view.byteLength &&
            (count_ == 0 ||
             (view.byteLength - accessor.byteOffset >= size &&
              (view.byteLength - accessor.byteOffset - size) / stride_ >= count_ - 1));
        if (!fits)
            fail(fmt::format("{} elements from byte {} reach over the end of a view of {}", count_,
                             accessor.byteOffset, view.byteLength));
        data_ = data.data() + view.byteOffset + accessor.byteOffset;
    }

    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] bool is_float() const { return component_type_ == TINYGLTF_COMPONENT_TYPE_FLOAT; }

    /// Integers that are `normalized` stand for -1 to 1, or 0 to 1.
    [[nodiscard]] double number(std::size_t element, std::size_t component) const {
        const unsigned char* at = data_ + element * stride_ + component * component_size_;
        switch (component_type_) {
            case TINYGLTF_COMPONENT_TYPE_FLOAT:
                return load<float>(at);
            case TINYGLTF_COMPONENT_TYPE_BYTE:
                return scaled(load<std::int8_t>(at));
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
                return scaled(load<std::uint8_t>(at));
            case TINYGLTF_COMPONENT_TYPE_SHORT:
                return scaled(load<std::int16_t>(at));
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
                return scaled(load<std::uint16_t>(at));
            case TINYGLTF_COMPONENT_TYPE_INT:
                return load<std::int32_t>(at);
            default:
                return load<std::uint32_t>(at);
        }
    }

    [[nodiscard]] Vec3d vector(std::size_t element) const {
        return {number(element, 0), number(element, 1), number(element, 2)};
    }

  private:
    template <class T>
    static T load(const unsigned char* at) {
        T value;
        std::memcpy(&value, at, sizeof(value));
        return value;
    }

    template <class T>
    [[nodiscard]] double scaled(T value) const {
        if (!normalized_) return value;
        return std::max(double(value) / std::numeric_limits<T>::max(), -1.0);
    }

    const unsigned char* data_ = nullptr;
    std::size_t count_ = 0, stride_ = 0, component_size_ = 0;
    int component_type_ = 0;
    bool normalized_ = false;
};

// Nodes ------------------------------------------------------------------------------------------

// Imath multiplies row vectors from the left, so its rows are glTF's columns.
Imath::M44d local_transform(const InputFile& file, const tinygltf::Node& node) {
    const auto sized = [&](const std::vector<double>& numbers, std::size_t expected,
                           const char* what) {
        if (numbers.empty()) return false;
        if (numbers.size() != expected)
            file.fail(fmt::format("the {} of a node has {} numbers (expected {})", what,
                                  numbers.size(), expected));
        return true;
    };
    Imath::M44d m;
    if (sized(node.matrix, 16, "matrix")) {
        for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = node.matrix[i];
        return m;
    }
    if (sized(node.scale, 3, "scale"))
        m.setScale(Vec3d(node.scale[0], node.scale[1], node.scale[2]));
    if (sized(node.rotation, 4, "rotation")) {
        const auto& q = node.rotation;  // x y z w
        m = m * Imath::Quatd(q[3], q[0], q[1], q[2]).normalized().toMatrix44();
    }
    if (sized(node.translation, 3, "translation")) {
        Imath::M44d moved;
        moved.setTranslation(Vec3d(node.translation[0], node.translation[1], node.translation[2]));
        m = m * moved;
    }
    return m;
}

// How normals go where points go by `m`: by its cofactors, which need no inverse. They are the
// inverse's transpose times the determinant, whose sign turns them around.
struct NormalTransform {
    Vec3d x, y, z;
    bool mirrored;

    explicit NormalTransform(const Imath::M44d& m) {
        const Vec3d a(m[0][0], m[0][1], m[0][2]), b(m[1][0], m[1][1], m[1][2]),
            c(m[2][0], m[2][1], m[2][2]);
        mirrored = a.dot(b.cross(c)) < 0;
        const double sign = mirrored ? -1 : 1;
        x = b.cross(c) * sign;
        y = c.cross(a) * sign;
        z = a.cross(b) * sign;
    }

    [[nodiscard]] Vec3f operator()(const Vec3d& n) const {
        return Vec3f((x * n.x + y * n.y + z * n.z).normalized());
    }
};

// Tangents go where points go, and the third axis turns around with a mirrored picture.
struct TangentTransform {
    Imath::M44d to_world;
    float sign;

    explicit TangentTransform(const Imath::M44d& m)
        : to_world(m),
          sign(NormalTransform(m).mirrored ? -1.0f : 1.0f) {}

    [[nodiscard]] Vec4f operator()(const Vec3d& tangent, double handedness) const {
        Vec3d turned;
        to_world.multDirMatrix(tangent, turned);
        return tangent_of(turned.normalized(), sign * static_cast<float>(handedness));
    }
};

class SceneFlattener {
  public:
    SceneFlattener(const InputFile& file, const tinygltf::Model& model, std::uint64_t memory_limit)
        : file_(file),
          model_(model),
          memory_limit_(memory_limit) {
        for (const tinygltf::Buffer& buffer : model.buffers)
            memory_ += static_cast<double>(buffer.data.size());
    }

    Mesh flatten() && {
        struct Visit {
            int node;
            Imath::M44d to_world;
        };
        std::vector<Visit> visits;
        const std::vector<int> roots = root_nodes();
        for (auto root = roots.rbegin(); root != roots.rend(); ++root)
            visits.push_back({*root, Imath::M44d()});

        std::vector<bool> seen(model_.nodes.size());
        while (!visits.empty()) {
            const auto [index, parent] = visits.back();
            visits.pop_back();
            if (index < 0 || static_cast<std::size_t>(index) >= model_.nodes.size())
                file_.fail(fmt::format("node {} is not there (the file has {})", index,
                                       model_.nodes.size()));
            // That also keeps a small file from meaning a huge scene.
            if (seen[index])
                file_.fail(fmt::format("node {} is reached twice (expected a tree)", index));
            seen[index] = true;
            const tinygltf::Node& node = model_.nodes[index];
            const Imath::M44d to_world = local_transform(file_, node) * parent;
            add_mesh(node.mesh, to_world);
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
                visits.push_back({*child, to_world});
        }
        if (!mesh_.tangents.empty()) mesh_.tangents.resize(mesh_.positions.size(), Vec4f(0));
        return std::move(mesh_);
    }

  private:
    // Of the default scene, else of the first; without any, all that are no one's children.
    [[nodiscard]] std::vector<int> root_nodes() const {
        if (!model_.scenes.empty()) {
            const int scene = std::max(model_.defaultScene, 0);
            if (static_cast<std::size_t>(scene) >= model_.scenes.size())
                file_.fail(fmt::format("scene {} is not there (the file has {})", scene,
                                       model_.scenes.size()));
            return model_.scenes[scene].nodes;
        }
        std::vector<bool> is_child(model_.nodes.size());
        for (const tinygltf::Node& node : model_.nodes)
            for (const int child : node.children)
                if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
                    is_child[child] = true;
        std::vector<int> roots;
        for (std::size_t i = 0; i < is_child.size(); ++i)
            if (!is_child[i]) roots.push_back(static_cast<int>(i));
        return roots;
    }

    void add_mesh(int index, const Imath::M44d& to_world) {
        if (index < 0) return;
        if (static_cast<std::size_t>(index) >= model_.meshes.size())
            file_.fail(
                fmt::format("mesh {} is not there (the file has {})", index, model_.meshes.size()));
        for (const tinygltf::Primitive& primitive : model_.meshes[index].primitives) {
            const bool triangles = primitive.mode == TINYGLTF_MODE_TRIANGLES ||
                                   primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
                                   primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
            if (triangles) add_primitive(primitive, to_world);
        }
    }

    void add_primitive(const tinygltf::Primitive& primitive, const Imath::M44d& to_world) {
        const auto positions = attribute(primitive, "POSITION", TINYGLTF_TYPE_VEC3);
        if (!positions) file_.fail("a primitive has no positions");
        const std::size_t count = positions->count();
        std::optional<Elements> indices;
        if (primitive.indices >= 0) {
            indices.emplace(file_, model_, primitive.indices, TINYGLTF_TYPE_SCALAR, "indices");
            if (indices->is_float()) file_.fail("indices are not integers");
        }
        const std::size_t corners = indices ? indices->count() : count;
        const bool has_tangents = primitive.attributes.contains("TANGENT");
        reserve(count, corners, has_tangents);

        const auto base = static_cast<std::uint32_t>(mesh_.positions.size());
        add_vertices(primitive, *positions, to_world);
        const bool mirrored = NormalTransform(to_world).mirrored;
        const auto corner = [&](std::size_t i) -> std::uint32_t {
            const double index = indices ? indices->number(i, 0) : static_cast<double>(i);
            if (!(index >= 0 && index < static_cast<double>(count)))
                file_.fail(fmt::format("index {} of a primitive with {} vertices", index, count));
            return base + static_cast<std::uint32_t>(index);
        };
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
            if (mirrored) std::swap(b, c);
            for (const std::size_t i : {a, b, c}) mesh_.indices.push_back(corner(i));
        };
        if (primitive.mode == TINYGLTF_MODE_TRIANGLES) {
            if (corners % 3 != 0)
                file_.fail(
                    fmt::format("{} corners of triangles (expected a multiple of 3)", corners));
            for (std::size_t i = 0; i < corners; i += 3) add(i, i + 1, i + 2);
        } else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            for (std::size_t i = 2; i < corners; ++i) add(i - 2, i - 1 + i % 2, i - i % 2);
        } else {
            for (std::size_t i = 2; i < corners; ++i) add(0, i - 1, i);
        }
    }

    // Refuses what cannot be held, before it is.
    void reserve(std::size_t vertices, std::size_t corners, bool has_tangents) {
        constexpr double kPerCorner = 12;  // strips: three indices for each
        const double per_vertex = has_tangents ? 48 : 32;
        memory_ +=
            per_vertex * static_cast<double>(vertices) + kPerCorner * static_cast<double>(corners);
        check_memory(file_, memory_, memory_limit_);
        constexpr std::size_t kMostVertices = std::numeric_limits<std::uint32_t>::max() - 1;
        if (vertices > kMostVertices - mesh_.positions.size())
            file_.fail(fmt::format("has more than {} vertices", kMostVertices));
    }

    std::optional<Elements> attribute(const tinygltf::Primitive& primitive, const char* name,
                                      int type) const {
        const auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end()) return std::nullopt;
        return Elements(file_, model_, found->second, type, name);
    }

    void add_vertices(const tinygltf::Primitive& primitive, const Elements& positions,
                      const Imath::M44d& to_world) {
        const std::size_t base = mesh_.positions.size(), count = positions.count();
        const auto check_count = [&](const std::optional<Elements>& other, const char* what) {
            if (other && other->count() != count)
                file_.fail(fmt::format("{} positions and {} {}", count, other->count(), what));
        };
        const auto normals = attribute(primitive, "NORMAL", TINYGLTF_TYPE_VEC3);
        const auto coordinates = attribute(primitive, "TEXCOORD_0", TINYGLTF_TYPE_VEC2);
        check_count(normals, "normals");
        check_count(coordinates, "texture coordinates");

        const NormalTransform turned(to_world);
        for (std::size_t i = 0; i < count; ++i) {
            Vec3d position;
            to_world.multDirMatrix(positions.vector(i), position);
            mesh_.positions.emplace_back(position + to_world.translation());
            mesh_.normals.push_back(normals ? turned(normals->vector(i)) : Vec3f(0));
        }
        // Tangents are of the normals beside them: glTF has those without passed over.
        if (normals) add_tangents(primitive, base, count, to_world);
        if (!coordinates && mesh_.texture_coordinates.empty()) return;
        mesh_.texture_coordinates.resize(base, Vec2f(0));
        for (std::size_t i = 0; i < count; ++i)
            mesh_.texture_coordinates.push_back(
                coordinates ? Vec2f(static_cast<float>(coordinates->number(i, 0)),
                                    static_cast<float>(coordinates->number(i, 1)))
                            : Vec2f(0));
    }

    void add_tangents(const tinygltf::Primitive& primitive, std::size_t base, std::size_t count,
                      const Imath::M44d& to_world) {
        const auto tangents = attribute(primitive, "TANGENT", TINYGLTF_TYPE_VEC4);
        if (!tangents) return;
        if (tangents->count() != count)
            file_.fail(fmt::format("{} positions and {} tangents", count, tangents->count()));
        const TangentTransform turned(to_world);
        mesh_.tangents.resize(base, Vec4f(0));
        for (std::size_t i = 0; i < count; ++i) {
            const double handedness = tangents->number(i, 3);
            if (std::abs(handedness) != 1)
                file_.fail(fmt::format("the tangent of vertex {} has w = {} (expected 1 or -1)", i,
                                       handedness));
            mesh_.tangents.push_back(turned(tangents->vector(i), handedness));
        }
    }

    const InputFile& file_;
    const tinygltf::Model& model_;
    std::uint64_t memory_limit_;
    double memory_ = 0;
    Mesh mesh_;
};

}  // namespace

Mesh read_gltf(InputFile& file, std::uint64_t memory_limit) {
    check_memory(file, static_cast<double>(file.size()), memory_limit);
    const Parts parts = read_parts(file);
    json document = parse_text(file, parts.text, memory_limit);
    check_is_supported(file, document);
    json geometry = only_geometry(document);
    BufferSource buffers(file, parts.binary, memory_limit);
    const tinygltf::Model model = parse(file, geometry, buffers);
    return SceneFlattener(file, model, memory_limit).flatten();
}

}  // namespace mirrorball::detail
