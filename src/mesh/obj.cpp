// Wavefront OBJ, parsed by tinyobjloader.
//
// The parser takes whatever it is given: words where numbers should be become 0, indices wrap, and
// its way of cutting polygons knows only simple ones. So its text is checked line by line before it
// sees it, it reports its finds one by one (its callback interface), and the rest is done here.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <istream>
#include <limits>
#include <span>
#include <streambuf>
#include <string>
#include <string_view>
#include <unordered_map>

#include <fmt/format.h>
#include <mirrorball/error.h>
#include <tiny_obj_loader.h>

#include "core/numbers.h"
#include "readers.h"
#include "triangulate.h"

namespace mirrorball::detail {
namespace {

// Messages quote no more of a file than this.
constexpr std::size_t kMostQuoted = 40;

struct Counts {
    std::uint64_t vertices = 0, corners = 0;
};

// Checks the lines that matter here, and takes out what the parser would misread.
class TextChecker {
  public:
    TextChecker(const InputFile& file, std::string& text) : file_(file), text_(text) {}

    Counts check() {
        std::size_t start = 0;
        while (start < text_.size()) {
            std::size_t end = end_of_line(start);
            // A backslash at the end of a line continues it; the parser does not know.
            while (is_continued(start, end)) {
                const std::size_t next = after_line(end);
                std::fill(text_.begin() + end - 1, text_.begin() + next, ' ');
                ++line_;
                end = end_of_line(next);
            }
            check_line(start, end);
            ++line_;
            start = after_line(end);
        }
        return counts_;
    }

  private:
    [[nodiscard]] std::size_t end_of_line(std::size_t from) const {
        return std::min(text_.find_first_of("\r\n", from), text_.size());
    }

    [[nodiscard]] std::size_t after_line(std::size_t end) const {
        return std::min(end + (text_.compare(end, 2, "\r\n") == 0 ? 2 : 1), text_.size());
    }

    [[nodiscard]] bool is_continued(std::size_t start, std::size_t end) const {
        return end > start && end < text_.size() && text_[end - 1] == '\\' && text_[start] != '#';
    }

    void check_line(std::size_t start, std::size_t end) {
        std::size_t at = start;
        const std::string_view keyword = next_word(at, end);
        if (keyword == "v")
            check_numbers(at, end, 3), ++counts_.vertices;
        else if (keyword == "vn")
            check_numbers(at, end, 3), ++counts_.vertices;
        else if (keyword == "vt")
            check_numbers(at, end, 1), ++counts_.vertices;
        else if (keyword == "f")
            check_face(at, end);
        else if (keyword.find('\0') != std::string_view::npos)
            fail("a byte of 0", "text");
    }

    std::string_view next_word(std::size_t& at, std::size_t end) const {
        while (at < end && is_space(text_[at])) ++at;
        const std::size_t start = at;
        while (at < end && !is_space(text_[at])) ++at;
        return std::string_view(text_).substr(start, at - start);
    }

    static bool is_space(char c) { return c == ' ' || c == '\t'; }

    // `least` numbers, and what follows them is passed over.
    void check_numbers(std::size_t at, std::size_t end, int least) {
        for (int i = 0; i < least; ++i) {
            const std::string_view word = next_word(at, end);
            if (word.empty()) fail(fmt::format("{} numbers", i), fmt::format("at least {}", least));
            if (!is_number(word)) fail(quoted(word), "a finite number");
        }
    }

    static bool is_number(std::string_view word) {
        if (word.front() == '+') word.remove_prefix(1);
        double value = 0;
        const auto [stop, error] = from_chars(word.data(), word.data() + word.size(), value);
        return error == std::errc() && stop == word.data() + word.size() &&
               std::abs(value) <= std::numeric_limits<float>::max();
    }

    void check_face(std::size_t at, std::size_t end) {
        std::uint64_t corners = 0;
        for (std::string_view word = next_word(at, end); !word.empty(); word = next_word(at, end)) {
            // "1/" and "1//", as some programs write; the parser would look for more.
            for (std::size_t last = at - 1; word.size() > 1 && word.back() == '/'; --last) {
                text_[last] = ' ';
                word.remove_suffix(1);
            }
            if (!is_corner(word)) fail(quoted(word), "an index: v, v/vt, v//vn or v/vt/vn");
            ++corners;
        }
        if (corners < 3) fail(fmt::format("a face of {} corners", corners), "at least 3");
        counts_.corners += corners;
    }

    static bool is_corner(std::string_view word) {
        for (int part = 0; part < 3; ++part) {
            const std::size_t slash = std::min(word.find('/'), word.size());
            const std::string_view index = word.substr(0, slash);
            if (!(part == 1 && index.empty()) && !is_index(index)) return false;
            if (slash == word.size()) return true;
            word.remove_prefix(slash + 1);
        }
        return false;
    }

    static bool is_index(std::string_view word) {
        if (!word.empty() && word.front() == '+') word.remove_prefix(1);
        int value = 0;
        const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        return error == std::errc() && stop == word.data() + word.size() && value != 0;
    }

    static std::string quoted(std::string_view word) {
        return fmt::format("'{}'", word.substr(0, kMostQuoted));
    }

    [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
        file_.fail(fmt::format("line {}: {} (expected {})", line_, found, expected));
    }

    const InputFile& file_;
    std::string& text_;
    std::uint64_t line_ = 1;
    Counts counts_;
};

// A stream over text that is somewhere already.
class TextBuffer : public std::streambuf {
  public:
    explicit TextBuffer(std::string& text) {
        setg(text.data(), text.data(), text.data() + text.size());
    }
};

// What the parser found. A corner's indices are as in the file: from 1, 0 for none; those counted
// back from the latest are made absolute at once.
struct Found {
    std::vector<Vec3f> positions, normals;
    std::vector<Vec2f> texture_coordinates;
    struct Corner {
        int position, texture_coordinate, normal;
        bool operator==(const Corner&) const = default;
    };
    std::vector<Corner> corners;
    std::vector<std::uint32_t> face_ends;  // in `corners`
};

int absolute(int index, std::size_t count) {
    if (index >= 0) return index;
    // One that counts back beyond the first becomes too large, for in_range() to refuse.
    const auto from_start = static_cast<std::int64_t>(count) + index + 1;
    return from_start > 0 ? static_cast<int>(from_start) : std::numeric_limits<int>::max();
}

Found parse(const InputFile& file, std::string& text) {
    tinyobj::callback_t callbacks;
    callbacks.vertex_cb = [](void* to, float x, float y, float z, float) {
        static_cast<Found*>(to)->positions.emplace_back(x, y, z);
    };
    callbacks.normal_cb = [](void* to, float x, float y, float z) {
        static_cast<Found*>(to)->normals.emplace_back(x, y, z);
    };
    // OBJ counts t upwards from the bottom.
    callbacks.texcoord_cb = [](void* to, float s, float t, float) {
        static_cast<Found*>(to)->texture_coordinates.emplace_back(s, 1 - t);
    };
    callbacks.index_cb = [](void* to, tinyobj::index_t* indices, int count) {
        Found& found = *static_cast<Found*>(to);
        for (int i = 0; i < count; ++i)
            found.corners.push_back(
                {absolute(indices[i].vertex_index, found.positions.size()),
                 absolute(indices[i].texcoord_index, found.texture_coordinates.size()),
                 absolute(indices[i].normal_index, found.normals.size())});
        found.face_ends.push_back(static_cast<std::uint32_t>(found.corners.size()));
    };
    Found found;
    TextBuffer buffer(text);
    std::istream stream(&buffer);
    std::string warning, error;
    if (!tinyobj::LoadObjWithCallback(stream, callbacks, &found, nullptr, &warning, &error))
        file.fail(fmt::format("cannot be parsed as OBJ ({})", error.substr(0, kMostQuoted)));
    return found;
}

struct CornerHash {
    std::size_t operator()(const Found::Corner& c) const {
        // Odd multipliers spread neighbouring indices over all bits.
        std::uint64_t h = static_cast<std::uint32_t>(c.position) * 0x9E3779B97F4A7C15u;
        h ^= static_cast<std::uint32_t>(c.texture_coordinate) * 0xC2B2AE3D27D4EB4Fu;
        h ^= static_cast<std::uint32_t>(c.normal) * 0x165667B19E3779F9u;
        return h ^ (h >> 29);
    }
};

// Corners that agree in all three indices become one vertex.
class MeshBuilder {
  public:
    MeshBuilder(const InputFile& file, const Found& found) : file_(file), found_(found) {}

    Mesh build() && {
        std::uint32_t start = 0;
        for (std::size_t face = 0; face < found_.face_ends.size(); ++face) {
            const std::uint32_t end = found_.face_ends[face];
            add_face(face, start, end);
            start = end;
        }
        return std::move(mesh_);
    }

  private:
    void add_face(std::size_t face, std::uint32_t start, std::uint32_t end) {
        std::vector<Vec3f> polygon;
        std::vector<std::uint32_t> vertices;
        for (std::uint32_t i = start; i < end; ++i) {
            const Found::Corner& corner = found_.corners[i];
            check_range(face, "position", corner.position, found_.positions.size());
            check_range(face, "texture coordinate", corner.texture_coordinate,
                        found_.texture_coordinates.size());
            check_range(face, "normal", corner.normal, found_.normals.size());
            polygon.push_back(found_.positions[corner.position - 1]);
            vertices.push_back(vertex_of(corner));
        }
        const auto triangles = triangulate(polygon);
        if (triangles.empty())
            file_.fail(fmt::format("face {} is not convex and has {} corners (expected at most {})",
                                   face + 1, polygon.size(), kMostConcaveCorners));
        for (const auto& triangle : triangles)
            for (const std::uint32_t corner : triangle) mesh_.indices.push_back(vertices[corner]);
    }

    void check_range(std::size_t face, const char* what, int index, std::size_t count) const {
        if (index >= 0 && static_cast<std::size_t>(index) <= count) return;
        file_.fail(fmt::format("face {} refers to a {} that is not there (the file has {})",
                               face + 1, what, count));
    }

    std::uint32_t vertex_of(const Found::Corner& corner) {
        const auto next = static_cast<std::uint32_t>(mesh_.positions.size());
        const auto [place, is_new] = vertices_.try_emplace(corner, next);
        if (is_new) {
            mesh_.positions.push_back(found_.positions[corner.position - 1]);
            mesh_.normals.push_back(corner.normal == 0 ? Vec3f(0)
                                                       : found_.normals[corner.normal - 1]);
            if (!found_.texture_coordinates.empty())
                mesh_.texture_coordinates.push_back(
                    corner.texture_coordinate == 0
                        ? Vec2f(0)
                        : found_.texture_coordinates[corner.texture_coordinate - 1]);
        }
        return place->second;
    }

    const InputFile& file_;
    const Found& found_;
    std::unordered_map<Found::Corner, std::uint32_t, CornerHash> vertices_;
    Mesh mesh_;
};

}  // namespace

Mesh read_obj(InputFile& file, std::uint64_t memory_limit) {
    check_memory(file, static_cast<double>(file.size()), memory_limit);
    std::string text(file.size(), '\0');
    file.read(std::as_writable_bytes(std::span<char>(text)));

    const Counts counts = TextChecker(file, text).check();
    // A corner: its indices, at most one vertex with its place in the table, and a triangle.
    constexpr double kPerVertex = sizeof(Vec3f), kPerCorner = 12 + 32 + 48 + 12;
    check_memory(file,
                 static_cast<double>(text.size()) +
                     kPerVertex * static_cast<double>(counts.vertices) +
                     kPerCorner * static_cast<double>(counts.corners),
                 memory_limit);
    constexpr std::uint64_t kMostCorners = std::numeric_limits<std::int32_t>::max();
    if (std::max(counts.vertices, counts.corners) > kMostCorners)
        file.fail(fmt::format("has faces of {} corners (expected at most {})", counts.corners,
                              kMostCorners));
    return MeshBuilder(file, parse(file, text)).build();
}

}  // namespace mirrorball::detail
