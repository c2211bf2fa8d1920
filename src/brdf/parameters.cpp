#include "brdf/parameters.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <mirrorball/error.h>

namespace mirrorball {
namespace detail {
namespace {

double parse_number(std::string_view name, std::string_view text) {
    const std::string copy(text);
    char* end = nullptr;
    const double value = std::strtod(copy.c_str(), &end);
    if (copy.empty() || end != copy.c_str() + copy.size())
        throw Error(Errc::usage, fmt::format("{} is \"{}\"; expected a number", name, text));
    return value;
}

// The part of `text` up to `separator`, which goes too.
std::string_view take_until(std::string_view& text, char separator) {
    const std::size_t end = std::min(text.find(separator), text.size());
    const std::string_view part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return part;
}

std::string range_text(double least, double most) {
    return fmt::format("{} to {}", least, most);
}

}  // namespace

void check_parameter(std::string_view name, double value, double least, double most) {
    if (value >= least && value <= most) return;
    throw Error(Errc::usage, fmt::format("{} is {}; expected a number from {}", name, value,
                                         range_text(least, most)));
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

Vec3d parse_colour(std::string_view name, std::string_view text) {
    const std::ptrdiff_t slash_count = std::count(text.begin(), text.end(), '/');
    if (slash_count == 0) return Vec3d(parse_number(name, text));
    if (slash_count != 2)
        throw Error(
            Errc::usage,
            fmt::format("{} is \"{}\"; expected one number or three, as 0.8/0.2/0.1", name, text));
    Vec3d colour;
    for (int c = 0; c < 3; ++c) colour[c] = parse_number(name, trimmed(take_until(text, '/')));
    return colour;
}

std::string colour_text(const Vec3d& c) {
    if (c.x == c.y && c.x == c.z) return fmt::format("{}", c.x);
    return fmt::format("{}/{}/{}", c.x, c.y, c.z);
}

void ParameterWriter::add(std::string_view name, const std::string& value) {
    text_ += fmt::format("{}{}={}", text_.empty() ? "" : ",", name, value);
}

void ParameterWriter::number(std::string_view name, double value, double, double) {
    add(name, fmt::format("{}", value));
}

void ParameterWriter::colour(std::string_view name, const Vec3d& value, double, double) {
    add(name, colour_text(value));
}

void ParameterWriter::roughness(double x, double y, double) {
    if (x == y) return add("roughness", fmt::format("{}", x));
    add("roughness-x", fmt::format("{}", x));
    add("roughness-y", fmt::format("{}", y));
}

void ParameterWriter::fresnel(const Fresnel& f) {
    const std::string text = to_string(f);
    if (!text.empty()) text_ += (text_.empty() ? "" : ",") + text;
}

void ParameterLister::add(const std::string& entry) {
    text_ += (text_.empty() ? "" : ", ") + entry;
}

void ParameterLister::number(std::string_view name, double value, double least, double most) {
    add(fmt::format("{} ({}) [{}]", name, range_text(least, most), value));
}

void ParameterLister::colour(std::string_view name, const Vec3d& value, double least, double most) {
    add(fmt::format("{} ({}) [{}]", name, range_text(least, most), colour_text(value)));
}

void ParameterLister::roughness(double x, double, double least) {
    number("roughness", x, least, 1);
    add("or roughness-x and roughness-y");
}

void ParameterLister::fresnel(const Fresnel& value) {
    const std::string usual = to_string(value);
    add(fmt::format("Fresnel by index, metal, n and k, or f0 and f90, under coat [{}]",
                    usual.empty() ? "1" : usual));
}

ParameterReader::ParameterReader(std::string_view text) {
    text = trimmed(text);
    while (!text.empty()) {
        const std::string_view entry = trimmed(take_until(text, ','));
        const std::size_t equals = std::min(entry.find('='), entry.find_first_of(" \t"));
        if (entry.empty()) throw Error(Errc::usage, "a parameter is missing between its commas");
        if (equals == std::string_view::npos && !entries_.empty())
            throw Error(Errc::usage,
                        fmt::format("\"{}\" is no parameter; expected name=value", entry));
        const bool named = equals != std::string_view::npos;
        std::string_view value = trimmed(named ? entry.substr(equals + 1) : entry);
        // "name = value"
        if (named && entry[equals] != '=' && value.starts_with('='))
            value = trimmed(value.substr(1));
        const std::string name(named ? trimmed(entry.substr(0, equals)) : "");
        for (const Entry& other : entries_) {
            if (other.name == name)
                throw Error(Errc::usage, fmt::format("{} is given twice", name));
        }
        entries_.push_back({name, std::string(value)});
    }
}

const std::string* ParameterReader::find(std::string_view name) {
    const bool first = known_.empty();
    known_.emplace_back(name);
    for (Entry& entry : entries_) {
        if (entry.name == name && !entry.used) {
            entry.used = true;
            return &entry.value;
        }
    }
    if (first && !entries_.empty() && entries_[0].name.empty()) {
        entries_[0].used = true;
        return &entries_[0].value;
    }
    return nullptr;
}

void ParameterReader::number(std::string_view name, double& value, double least, double most) {
    const std::string* text = find(name);
    if (text == nullptr) return;
    value = parse_number(name, *text);
    check_parameter(name, value, least, most);
}

void ParameterReader::colour(std::string_view name, Vec3d& value, double least, double most) {
    const std::string* text = find(name);
    if (text == nullptr) return;
    value = parse_colour(name, *text);
    for (int c = 0; c < 3; ++c) check_parameter(name, value[c], least, most);
}

void ParameterReader::roughness(double& x, double& y, double least) {
    double both = -1;
    number("roughness", both, least, 1);
    if (both >= 0) x = y = both;
    number("roughness-x", x, least, 1);
    number("roughness-y", y, least, 1);
}

void ParameterReader::fresnel(Fresnel& value) {
    const std::string *index = find("index"), *metal = find("metal"), *n = find("n"),
                      *k = find("k"), *f0 = find("f0"), *f90 = find("f90"), *coat = find("coat");
    const int ways = (index != nullptr) + (metal != nullptr) + (n != nullptr) + (f0 != nullptr);
    if (ways > 1)
        throw Error(Errc::usage, "expected one of index, metal, n and k, or f0; found several");
    if ((k != nullptr) != (n != nullptr)) throw Error(Errc::usage, "n and k go together");
    if (f90 != nullptr && f0 == nullptr) throw Error(Errc::usage, "f90 needs f0");
    if (index != nullptr) value = Fresnel::dielectric(parse_number("index", *index));
    if (metal != nullptr) value = Fresnel::conductor(std::string_view(*metal));
    if (n != nullptr) value = Fresnel::conductor(parse_colour("n", *n), parse_colour("k", *k));
    if (f0 != nullptr)
        value = Fresnel::schlick(parse_colour("f0", *f0),
                                 f90 != nullptr ? parse_colour("f90", *f90) : Vec3d(1));
    if (coat != nullptr) value = value.coated(parse_number("coat", *coat));
}

void ParameterReader::finish() const {
    for (const Entry& entry : entries_) {
        if (entry.used) continue;
        if (known_.empty()) throw Error(Errc::usage, "it has no parameters");
        throw Error(Errc::usage, fmt::format("no parameter \"{}\"; there are {}",
                                             entry.name.empty() ? entry.value : entry.name,
                                             fmt::join(known_, ", ")));
    }
}

}  // namespace detail

std::string to_string(const Fresnel& f) {
    using detail::colour_text;
    std::string text;
    switch (f.kind()) {
        case Fresnel::Kind::ideal:
            return "";
        case Fresnel::Kind::dielectric:
            text = fmt::format("index={}", f.index().x);
            break;
        case Fresnel::Kind::conductor:
            text = fmt::format("n={},k={}", colour_text(f.index()), colour_text(f.extinction()));
            for (const Metal& metal : metals()) {
                if (metal.index == f.index() && metal.extinction == f.extinction())
                    text = fmt::format("metal={}", metal.name);
            }
            break;
        case Fresnel::Kind::schlick:
            text = fmt::format("f0={}", colour_text(f.f0()));
            if (f.f90() != Vec3d(1)) text += fmt::format(",f90={}", colour_text(f.f90()));
            break;
    }
    if (f.coat() != 1) text += fmt::format(",coat={}", f.coat());
    return text;
}

Fresnel parse_fresnel(std::string_view text) {
    try {
        detail::ParameterReader reader(text);
        Fresnel fresnel;
        reader.fresnel(fresnel);
        reader.finish();
        return fresnel;
    } catch (const Error& error) {
        throw Error(error.code(), fmt::format("Fresnel \"{}\": {}", text, error.what()));
    }
}

}  // namespace mirrorball
