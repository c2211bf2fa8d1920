#include "html.h"

#include <fmt/format.h>

namespace mirrorball::cli {
namespace {

const char* const kStyle = R"(
:root {
  color-scheme: light dark;
  --page: #f6f6f3; --card: #ffffff; --ink: #17191c; --soft: #5b6067; --line: #e2e2dd;
  --accent: #0b5fae; --well: #ecece8;
}
@media (prefers-color-scheme: dark) {
  :root { --page: #101214; --card: #191c1f; --ink: #eceef0; --soft: #a2a9b1; --line: #2b3035;
          --accent: #7cb8f2; --well: #0a0b0d; }
}
* { box-sizing: border-box; }
html { -webkit-text-size-adjust: 100%; }
body { margin: 0; background: var(--page); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", sans-serif; }
img { display: block; width: 100%; height: auto; }
main, .title { max-width: 1180px; margin: 0 auto; padding: 0 20px; }
.hero { background: #000; }
.hero img { width: 100%; max-height: min(50vw, 400px); object-fit: cover; }
.title { padding-top: 28px; }
h1 { font-size: clamp(28px, 5vw, 44px); line-height: 1.15; letter-spacing: -0.02em; margin: 0;
  overflow-wrap: anywhere; }
.lead { color: var(--soft); margin: 8px 0 0; font-size: 17px; }
h2 { font-size: 24px; letter-spacing: -0.01em; line-height: 1.25; margin: 60px 0 6px; }
h3 { font-size: 16px; margin: 0; }
p { margin: 0 0 14px; max-width: 72ch; }
section > p { color: var(--soft); }
code { font: 0.92em/1.4 ui-monospace, SFMono-Regular, Menlo, Consolas, monospace;
  overflow-wrap: anywhere; }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(160px, 1fr)); gap: 12px;
  margin: 26px 0 0; padding: 0; }
.tiles div, .card { background: var(--card); border: 1px solid var(--line); border-radius: 14px; }
.tiles div { padding: 14px 16px; }
.tiles dt { color: var(--soft); font-size: 13px; }
.tiles dd { margin: 2px 0 0; font-size: 22px; font-weight: 600; letter-spacing: -0.01em;
  font-variant-numeric: tabular-nums; }
.tiles dd small { display: block; font-size: 13px; font-weight: 400; color: var(--soft);
  letter-spacing: 0; }
.grid { display: grid; gap: 0 16px; grid-template-columns: repeat(auto-fill, minmax(min(100%, 212px), 1fr));
  margin-top: 18px; }
.two { grid-template-columns: repeat(auto-fill, minmax(min(100%, 440px), 1fr)); }
/* pictures and captions share the rows of the grid, so that a row's captions begin at one height */
.card { margin: 0; overflow: hidden; display: grid; grid-row: span 2; grid-template-rows: subgrid;
  row-gap: 0; margin-bottom: 16px; }
.levels { grid-row: span 3; }
.well { background: var(--well); padding: 16px; display: flex; align-items: center;
  justify-content: center; gap: 12px; }
figcaption { padding: 14px 16px 16px; }
figcaption p { color: var(--soft); font-size: 14px; margin: 4px 0 0; }
.round { clip-path: circle(49.7%); }
.ball { width: min(100%, 220px); }
.pair img { width: calc(50% - 6px); }
.unfolded { position: relative; width: 100%; }
.unfolded img { clip-path: polygon(25.1% 0, 49.9% 0, 49.9% 33.4%, 100% 33.4%, 100% 66.6%, 49.9% 66.6%,
  49.9% 100%, 25.1% 100%, 25.1% 66.6%, 0 66.6%, 0 33.4%, 25.1% 33.4%); }
.unfolded span { position: absolute; padding: 1px 8px; margin: 8px; border-radius: 99px;
  background: rgb(0 0 0 / 0.62); color: #fff; font-size: 12px; line-height: 1.6; }
.shelves { display: grid; gap: 16px; margin-top: 18px; }
.shelf { grid-row: auto; margin: 0; grid-template: auto / minmax(200px, 260px) 1fr; }
.shelf figcaption { order: -1; align-self: center; padding: 16px 20px; }
.shelf .well { display: grid; gap: 20px 28px; padding: 24px; align-items: end;
  grid-template-columns: repeat(var(--balls), minmax(0, 200px)); }
.shelf span { display: block; text-align: center; color: var(--soft); font-size: 14px;
  line-height: 1.35; margin-top: 10px; min-height: 1.35em; }
.axes { display: grid; grid-template-columns: 1fr 1fr; gap: 4px; width: min(100%, 330px);
  color: var(--soft); font-size: 13px; }
.axes img { grid-column: span 2; }
.axes span:nth-of-type(2) { text-align: right; }
.facts { display: grid; grid-template-columns: auto 1fr; gap: 2px 12px; margin: 10px 0 0;
  font-size: 14px; }
.facts dt { color: var(--soft); }
.facts dd { margin: 0; text-align: right; font-variant-numeric: tabular-nums; }
.scroll { overflow-x: auto; margin-top: 16px; }
table { border-collapse: collapse; width: 100%; font-size: 15px; background: var(--card); }
th, td { text-align: left; padding: 10px 14px; border-bottom: 1px solid var(--line);
  vertical-align: top; }
tr:last-child td { border-bottom: 0; }
th { font-size: 13px; font-weight: 600; color: var(--soft); white-space: nowrap; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
a { color: var(--accent); }
a:focus-visible, .scroll:focus-visible { outline: 3px solid var(--accent); outline-offset: 2px; }
.times { list-style: none; margin: 18px 0 0; padding: 0; display: grid; gap: 8px; }
.times li { display: grid; grid-template-columns: minmax(120px, 180px) 1fr 64px; gap: 12px;
  align-items: center; font-size: 15px; }
.times b { display: block; height: 10px; border-radius: 99px; background: var(--accent);
  min-width: 3px; }
.times em { font-style: normal; text-align: right; font-variant-numeric: tabular-nums;
  color: var(--soft); }
footer { color: var(--soft); font-size: 14px; padding: 56px 0 40px; }
@media (max-width: 560px) {
  main, .title { padding-left: 16px; padding-right: 16px; }
  h2 { margin-top: 44px; }
  .tiles { grid-template-columns: 1fr 1fr; gap: 8px; }
  .tiles div { padding: 12px; }
  .tiles dd { font-size: 18px; }
  .shelf { display: block; }
  .shelf .well { grid-template-columns: repeat(2, minmax(0, 200px)); gap: 16px; padding: 16px; }
  .unfolded span { font-size: 10px; margin: 3px; padding: 0 5px; }
  .times li { grid-template-columns: 112px 1fr 56px; }
}
)";

}  // namespace

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::string html_page(std::string_view title, std::string_view top, std::string_view main) {
    return fmt::format(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<title>{} · mirrorball</title>\n<style>{}</style>\n</head>\n<body>\n"
        "{}<main>\n{}</main>\n</body>\n</html>\n",
        escaped(title), kStyle, top, main);
}

std::string html_fact(std::string_view name, std::string_view value) {
    return fmt::format("<dt>{}</dt><dd>{}</dd>", name, value);
}

}  // namespace mirrorball::cli
