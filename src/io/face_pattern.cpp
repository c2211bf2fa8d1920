#include "face_pattern.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <mirrorball/error.h>

namespace mirrorball::detail {
namespace {

using Names = std::vector<std::string>;

struct Scheme {
    Projection projection;
    Names names;
};

// In the order of the faces. `front` is what a cube's own +Z looks at: in our default axes that is
// world -Z, straight ahead. The first of each projection is the one that we write.
const std::vector<Scheme>& schemes() {
    static const std::vector<Scheme> all = {
        {Projection::cube, {"px", "nx", "py", "ny", "pz", "nz"}},
        {Projection::cube, {"posx", "negx", "posy", "negy", "posz", "negz"}},
        {Projection::cube, {"right", "left", "top", "bottom", "front", "back"}},
        {Projection::cube, {"right", "left", "up", "down", "front", "back"}},
        {Projection::cube, {"rt", "lf", "up", "dn", "ft", "bk"}},
        {Projection::cube, {"+x", "-x", "+y", "-y", "+z", "-z"}},
        {Projection::cube, {"0", "1", "2", "3", "4", "5"}},
        {Projection::dual_paraboloid, {"front", "back"}},
        {Projection::dual_paraboloid, {"0", "1"}},
    };
    return all;
}

std::string upper(std::string text, std::size_t count) {
    for (std::size_t i = 0; i < std::min(count, text.size()); ++i) {
        text[i] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[i])));
    }
    return text;
}

// The scheme's names as they stand, in capitals, and with a capital letter in front.
std::vector<Names> spellings(const Names& names) {
    std::vector<Names> all = {names};
    for (const std::size_t capital_count : {std::string::npos, std::size_t{1}}) {
        Names spelling;
        for (const std::string& face : names) spelling.push_back(upper(face, capital_count));
        if (std::find(all.begin(), all.end(), spelling) == all.end()) all.push_back(spelling);
    }
    return all;
}

std::string replace_face(std::string pattern, std::string_view face) {
    for (std::size_t at = 0; (at = pattern.find("%s", at)) != std::string::npos;) {
        pattern.replace(at, 2, face);
        at += face.size();
    }
    return pattern;
}

struct Candidate {
    Projection projection;
    Names names, missing;

    [[nodiscard]] std::size_t found_count() const { return names.size() - missing.size(); }
};

Candidate look_for(const std::string& pattern, Projection projection, const Names& names) {
    Candidate candidate{projection, names, {}};
    for (const std::string& face : names) {
        std::error_code ignored;
        if (!std::filesystem::exists(replace_face(pattern, face), ignored)) {
            candidate.missing.push_back(face);
        }
    }
    return candidate;
}

// The spelling of a scheme of which most files are there.
Candidate best_spelling(const std::string& pattern, const Scheme& scheme) {
    std::optional<Candidate> best;
    for (const Names& names : spellings(scheme.names)) {
        Candidate candidate = look_for(pattern, scheme.projection, names);
        if (!best || candidate.found_count() > best->found_count()) best = std::move(candidate);
    }
    return *best;
}

[[noreturn]] void fail_without_files(const std::string& pattern,
                                     std::optional<Projection> projection) {
    std::string known;
    for (const Scheme& scheme : schemes()) {
        if (projection && scheme.projection != *projection) continue;
        known += fmt::format("{}{}", known.empty() ? "" : "; ", fmt::join(scheme.names, " "));
    }
    throw Error(Errc::cannot_read,
                fmt::format("{}: no such files; expected one of each of: {}", pattern, known));
}

[[noreturn]] void fail_with_missing(const std::string& pattern, const Candidate& candidate) {
    Names files;
    for (const std::string& face : candidate.missing) files.push_back(replace_face(pattern, face));
    throw Error(Errc::cannot_read,
                fmt::format("{}: {} of the {} faces {} are there; missing: {}", pattern,
                            candidate.found_count(), candidate.names.size(),
                            fmt::join(candidate.names, " "), fmt::join(files, ", ")));
}

std::vector<std::filesystem::path> paths_of(const std::string& pattern, const Names& names) {
    std::vector<std::filesystem::path> paths;
    for (const std::string& face : names) paths.emplace_back(replace_face(pattern, face));
    return paths;
}

}  // namespace

bool is_face_pattern(std::string_view name) {
    return name.find("%s") != std::string_view::npos;
}

FaceFiles find_face_files(const std::string& pattern, std::optional<Projection> projection) {
    if (projection && face_count(*projection) == 1) {
        throw Error(Errc::usage, fmt::format("{}: %s stands for a face, and {} maps have only one",
                                             pattern, name(*projection)));
    }

    // The scheme with most files there wins: five of six faces are a cube that misses one, even
    // where two of them would make a pair of paraboloids.
    std::vector<Candidate> best;
    for (const Scheme& scheme : schemes()) {
        if (projection && scheme.projection != *projection) continue;
        Candidate candidate = best_spelling(pattern, scheme);
        if (!best.empty() && candidate.found_count() > best.front().found_count()) best.clear();
        if (best.empty() || candidate.found_count() == best.front().found_count()) {
            best.push_back(std::move(candidate));
        }
    }
    if (best.front().found_count() == 0) fail_without_files(pattern, projection);

    // Of equally many files, a whole set goes before parts of one; two whole sets are one too many.
    std::stable_partition(best.begin(), best.end(),
                          [](const Candidate& c) { return c.missing.empty(); });
    const Candidate& chosen = best.front();
    if (!chosen.missing.empty()) fail_with_missing(pattern, chosen);
    if (best.size() > 1 && best[1].missing.empty()) {
        throw Error(
            Errc::cannot_read,
            fmt::format("{}: there are two sets of faces, {} and {}; name the six files, "
                        "separated by commas",
                        pattern, fmt::join(chosen.names, " "), fmt::join(best[1].names, " ")));
    }
    return {chosen.projection, paths_of(pattern, chosen.names),
            fmt::format("read as the faces {} of a {} map", fmt::join(chosen.names, " "),
                        name(chosen.projection))};
}

FaceFiles split_face_list(const std::string& list) {
    FaceFiles result{Projection::cube, {}, {}};
    for (std::size_t start = 0; start <= list.size();) {
        const std::size_t end = std::min(list.find(',', start), list.size());
        result.files.emplace_back(list.substr(start, end - start));
        start = end + 1;
    }
    if (result.files.size() == 2) {
        result.projection = Projection::dual_paraboloid;
    } else if (result.files.size() != 6) {
        throw Error(Errc::usage,
                    fmt::format("{}: {} files; expected the 6 faces of a cube (+X -X +Y -Y +Z -Z) "
                                "or the 2 of a dual paraboloid (front, back)",
                                list, result.files.size()));
    }
    return result;
}

std::vector<std::filesystem::path> face_targets(const std::string& pattern, Projection projection) {
    const auto scheme = std::find_if(schemes().begin(), schemes().end(),
                                     [&](const Scheme& s) { return s.projection == projection; });
    if (scheme == schemes().end()) {
        throw Error(Errc::usage, fmt::format("{}: %s stands for a face, and {} maps have only one",
                                             pattern, name(projection)));
    }
    return paths_of(pattern, scheme->names);
}

}  // namespace mirrorball::detail
