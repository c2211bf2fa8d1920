// Parameters of BRDFs: their names and ranges, stated once.
//
// visit(parameters, visitor) shows a visitor each field of a model. One visitor checks, one reads
// text, one writes it, one lists names and ranges for help texts; so these cannot drift apart.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <mirrorball/brdf.h>
#include <mirrorball/fresnel.h>
#include <mirrorball/lobe.h>

namespace mirrorball::detail {

/// \throws Error(Errc::usage) "NAME is VALUE; expected a number from LEAST to MOST"
void check_parameter(std::string_view name, double value, double least, double most);

/// "0.5" or "0.5/0.2/0.1". \throws Error(Errc::usage)
[[nodiscard]] Vec3d parse_colour(std::string_view name, std::string_view text);
[[nodiscard]] std::string colour_text(const Vec3d& colour);
[[nodiscard]] std::string_view trimmed(std::string_view text);

// The name by which parse_brdf() knows a model.
constexpr std::string_view model_name(const Lambert&) {
    return "lambert";
}
constexpr std::string_view model_name(const OrenNayar&) {
    return "oren-nayar";
}
constexpr std::string_view model_name(const Phong& p) {
    if (p.form == Phong::Form::plain) return "phong-plain";
    return p.form == Phong::Form::lewis ? "phong-lewis" : "phong";
}
constexpr std::string_view model_name(const BlinnPhong&) {
    return "blinn-phong";
}
constexpr std::string_view model_name(const Lafortune&) {
    return "lafortune";
}
constexpr std::string_view model_name(const Ward& p) {
    return p.form == Ward::Form::original ? "ward-original" : "ward";
}
constexpr std::string_view model_name(const Banks&) {
    return "banks";
}
constexpr std::string_view model_name(const Microfacet& p) {
    return p.distribution == Microfacet::Distribution::ggx ? "ggx" : "beckmann";
}
constexpr std::string_view model_name(const Sheen&) {
    return "charlie";
}
constexpr std::string_view model_name(const Mirror&) {
    return "mirror";
}
constexpr std::string_view model_name(const Plastic&) {
    return "plastic";
}

inline constexpr double kMostExponent = 1e6, kMostLobeAxis = 10;
/// Microfacets smoother than this are a mirror.
inline constexpr double kLeastRoughness = 0.01;

template <class V>
void visit(Lambert& p, V& v) {
    v.colour("reflectance", p.reflectance, 0, 1);
}

template <class V>
void visit(OrenNayar& p, V& v) {
    v.number("sigma", p.sigma_degrees, 0, 90);
    v.colour("reflectance", p.reflectance, 0, 1);
}

template <class V>
void visit(Phong& p, V& v) {
    v.number("exponent", p.exponent, 0, kMostExponent);
    v.colour("reflectance", p.reflectance, 0, 1);
}

template <class V>
void visit(BlinnPhong& p, V& v) {
    v.number("exponent", p.exponent, 0, kMostExponent);
    v.colour("reflectance", p.reflectance, 0, 1);
}

template <class V>
void visit(Lafortune& p, V& v) {
    v.number("exponent", p.exponent, 0, kMostExponent);
    v.number("kx", p.k.x, -kMostLobeAxis, kMostLobeAxis);
    v.number("ky", p.k.y, -kMostLobeAxis, kMostLobeAxis);
    v.number("kz", p.k.z, -kMostLobeAxis, kMostLobeAxis);
    v.colour("reflectance", p.reflectance, 0, 1);
}

template <class V>
void visit(Ward& p, V& v) {
    v.roughness(p.roughness_x, p.roughness_y, kLeastRoughness);
    v.colour("reflectance", p.reflectance, 0, 1);
}

template <class V>
void visit(Banks& p, V& v) {
    v.number("exponent", p.exponent, 0, kMostExponent);
    v.colour("reflectance", p.reflectance, 0, 1);
}

template <class V>
void visit(Microfacet& p, V& v) {
    v.roughness(p.roughness_x, p.roughness_y, 0);
    v.fresnel(p.fresnel);
}

template <class V>
void visit(Sheen& p, V& v) {
    v.number("roughness", p.roughness, kLeastCharlieRoughness, 1);
    v.colour("reflectance", p.reflectance, 0, 1);
}

template <class V>
void visit(Mirror& p, V& v) {
    v.fresnel(p.fresnel);
}

template <class V>
void visit(Plastic& p, V& v) {
    v.colour("reflectance", p.reflectance, 0, 1);
    v.number("roughness", p.roughness, 0, 1);
    v.fresnel(p.fresnel);
}

/// Throws at the first parameter out of its range.
class ParameterChecker {
  public:
    static void number(std::string_view name, double value, double least, double most) {
        check_parameter(name, value, least, most);
    }
    static void colour(std::string_view name, const Vec3d& value, double least, double most) {
        for (int c = 0; c < 3; ++c) check_parameter(name, value[c], least, most);
    }
    static void roughness(double x, double y, double least) {
        check_parameter(x == y ? "roughness" : "roughness-x", x, least, 1);
        check_parameter("roughness-y", y, least, 1);
    }
    static void fresnel(const Fresnel&) {}  // cannot be made out of its ranges
};

/// "name=value,name=value"
class ParameterWriter {
  public:
    void number(std::string_view name, double value, double, double);
    void colour(std::string_view name, const Vec3d& value, double, double);
    void roughness(double x, double y, double);
    void fresnel(const Fresnel& value);
    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    void add(std::string_view name, const std::string& value);
    std::string text_;
};

/// "name (least to most), ..."
class ParameterLister {
  public:
    void number(std::string_view name, double value, double least, double most);
    void colour(std::string_view name, const Vec3d& value, double least, double most);
    void roughness(double x, double y, double least);
    void fresnel(const Fresnel& value);
    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    void add(const std::string& entry);
    std::string text_;
};

/// Fields from "name=value" or "name value" after commas; the first without a name goes to the
/// field that is visited first.
class ParameterReader {
  public:
    /// \param text  what follows a model's name and its colon
    explicit ParameterReader(std::string_view text);

    void number(std::string_view name, double& value, double least, double most);
    void colour(std::string_view name, Vec3d& value, double least, double most);
    void roughness(double& x, double& y, double least);
    void fresnel(Fresnel& value);
    /// \throws Error(Errc::usage) naming a parameter that nothing asked for, and those there are
    void finish() const;

  private:
    struct Entry {
        std::string name, value;
        bool used = false;
    };
    // The value given to a name; null if there is none. Each call makes a name known.
    const std::string* find(std::string_view name);

    std::vector<Entry> entries_;
    std::vector<std::string> known_;
};

template <class P>
void check_parameters(const P& parameters) {
    P copy = parameters;
    ParameterChecker checker;
    visit(copy, checker);
}

template <class P>
std::string model_text(const P& parameters) {
    P copy = parameters;
    ParameterWriter writer;
    visit(copy, writer);
    std::string text(model_name(parameters));
    if (!writer.text().empty()) text += ":" + writer.text();
    return text;
}

}  // namespace mirrorball::detail
