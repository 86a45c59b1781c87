#pragma once

namespace tachylite {

/// The style sheets of plots and of the rest of the report's page, and its script.
inline constexpr const char* kPlotStyle = R"(
:root { --paper: #fbfaf7; --card: #fff; --ink: #23241f; --soft: #6d6f66; --line: #e3e1d9; --accent: #b4441a;
  --c0: #b4441a; --c1: #2b6a99; --c2: #4b7f3b; --c3: #80539a; --c4: #a8821b; --c5: #2d8079; --c6: #8f8f88; }
@media (prefers-color-scheme: dark) { :root { --paper: #191a18; --card: #22231f; --ink: #ecebe4; --soft: #a5a69c;
  --line: #393a34; --accent: #f08a5a; --c0: #f08a5a; --c1: #7cb8e3; --c2: #97cf82; --c3: #c59be0; --c4: #e0bd5c;
  --c5: #72c9c1; --c6: #9a9a92; } }
svg .grid { stroke: var(--line); }
svg .tick, svg .label { fill: var(--soft); font-size: 12px; }
svg .key { fill: var(--ink); font-size: 12.5px; }
.series path { fill: none; stroke: var(--c); stroke-width: 2; stroke-linejoin: round; }
.series circle { fill: var(--card); stroke: var(--c); stroke-width: 2; }
.series .bar { stroke: var(--c); stroke-width: 1.4; }
.guide path { stroke-width: 1.2; stroke-dasharray: 4 4; }
.s0 { --c: var(--c0); } .s1 { --c: var(--c1); } .s2 { --c: var(--c2); } .s3 { --c: var(--c3); }
.s4 { --c: var(--c4); } .s5 { --c: var(--c5); } .s6 { --c: var(--c6); }
text { font-family: system-ui, "Helvetica Neue", Arial, sans-serif; font-variant-numeric: tabular-nums; }
svg .title { fill: var(--ink); font-size: 15px; font-weight: 650; }
)";

inline constexpr const char* kPageStyle = R"(
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, "Helvetica Neue", Arial, sans-serif; font-variant-numeric: tabular-nums; }
main { max-width: 1340px; margin: 0 auto; padding: 36px 28px 60px; }
h1 { font-size: 30px; font-weight: 650; letter-spacing: -.02em; margin: 0; }
h2 { font-size: 21px; font-weight: 650; margin: 44px 0 2px; }
h3 { font-size: 13px; font-weight: 650; margin: 0 0 10px; }
p.sub { color: var(--soft); margin: 2px 0 16px; }
.cards { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 18px; align-items: start; }
@media (max-width: 980px) { .cards { grid-template-columns: minmax(0, 1fr); } }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 18px 20px; min-width: 0; }
.column { display: grid; gap: 18px; min-width: 0; }
.wide { grid-column: 1 / -1; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 13.5px; white-space: nowrap; }
th { text-align: right; font-weight: 600; color: var(--soft); border-bottom: 1px solid var(--line); padding: 4px 10px; }
td { text-align: right; padding: 4px 10px; border-bottom: 1px solid var(--line); }
tr:last-child td { border-bottom: 0; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
td small { display: block; color: var(--soft); font-size: 11.5px; font-weight: 400; line-height: 1.25; }
td.good { color: var(--accent); font-weight: 650; }
svg.plot { width: 100%; height: auto; display: block; }
.compare { position: relative; line-height: 0; border-radius: 6px; overflow: hidden; touch-action: none; cursor: ew-resize;
  background: #000; }
.compare img { width: 100%; image-rendering: pixelated; user-select: none; }
.compare img + img { position: absolute; inset: 0; clip-path: inset(0 0 0 var(--at)); }
.compare::after { content: ""; position: absolute; top: 0; bottom: 0; left: var(--at); width: 2px; margin-left: -1px;
  background: #fff; box-shadow: 0 0 4px #0009; }
.choose { display: flex; justify-content: space-between; gap: 10px; margin-bottom: 10px; }
select { font: inherit; font-size: 13px; color: var(--ink); background: var(--paper); border: 1px solid var(--line);
  border-radius: 6px; padding: 4px 8px; max-width: 49%; }
input[type=range] { width: 100%; accent-color: var(--accent); margin: 10px 0 0; }
.scale { display: flex; align-items: center; gap: 8px; color: var(--soft); font-size: 12px; margin-top: 8px; }
.scale i { flex: 1; height: 9px; border-radius: 5px; background: linear-gradient(90deg, #05050f, #3d1466, #8f296b,
  #de5242, #faa138, #fcf7b8); }
.stage { display: grid; grid-template-columns: minmax(120px, 34%) 1fr 132px; gap: 12px; align-items: center;
  font-size: 13px; margin: 5px 0; }
.stage b { font-weight: 400; overflow: hidden; text-overflow: ellipsis; white-space: nowrap; }
.stage i { height: 12px; border-radius: 3px; background: var(--c1); min-width: 1px; display: block; }
.stage.start i { background: var(--c4); }
td { vertical-align: top; }
p.part { color: var(--soft); font-size: 13px; margin: 14px 0 6px; }
.stage span { text-align: right; color: var(--soft); }
footer { color: var(--soft); font-size: 13px; margin-top: 40px; max-width: 90ch; }
)";

inline constexpr const char* kPageScript = R"(
for (const box of document.querySelectorAll(".pictures")) {
  const frame = box.querySelector(".compare"), range = box.querySelector("input");
  const images = frame.querySelectorAll("img"), choices = box.querySelectorAll("select");
  const store = JSON.parse(box.querySelector("script").textContent);
  const move = at => { range.value = at; frame.style.setProperty("--at", at + "%"); };
  choices.forEach((choice, i) => {
    const show = () => { images[i].src = store[choice.selectedIndex]; images[i].alt = choice.value; };
    choice.addEventListener("change", show);
    show();
  });
  range.addEventListener("input", () => move(range.value));
  const drag = event => {
    const area = frame.getBoundingClientRect();
    move(Math.min(100, Math.max(0, 100 * (event.clientX - area.left) / area.width)));
  };
  frame.addEventListener("pointerdown", event => { event.preventDefault(); frame.setPointerCapture(event.pointerId); drag(event); });
  frame.addEventListener("pointermove", event => { if (event.buttons) drag(event); });
  move(50);
}
document.documentElement.dataset.ready = document.querySelectorAll(".compare img[src^='data:']").length;
)";

}  // namespace tachylite
