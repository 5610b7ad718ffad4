// Draws the plots from the JSON in #data: [{title, x, y, logarithmic, bars, tornado, labels: [text], lines: [{name, values}]}].
(function () {
  "use strict";
  if (typeof Chart === "undefined") return;
  const plots = JSON.parse(document.getElementById("data").textContent);
  const place = document.querySelector("#charts .charts");
  document.getElementById("charts").hidden = plots.length === 0;
  Chart.defaults.animation = false;
  Chart.defaults.maintainAspectRatio = false;
  const colours = ["#3b6fb6", "#e08a2e", "#4c9a5b", "#b0457a", "#7a62b8", "#8a6d3b", "#4aa3a3", "#777c88"];
  const axis = text => ({ title: { display: true, text: text } });
  const units = [[1e12, "T"], [1e9, "G"], [1e6, "M"], [1e3, "k"]];

  // 1e-5, 0.02, 500, 20 k, 3 M
  function short(number) {
    if (number !== 0 && Math.abs(number) < 1e-3) return Number(number.toPrecision(6)).toExponential();
    const unit = units.find(([size]) => Math.abs(number) >= 1e4 && Math.abs(number) >= size);
    return unit ? Number((number / unit[0]).toPrecision(6)) + " " + unit[1] : String(Number(number.toPrecision(6)));
  }
  // Labels for as many ticks as Chart.js has room for.
  function logarithmicTick(number, index, ticks) {
    return Chart.Ticks.formatters.logarithmic.call(this, number, index, ticks) === "" ? "" : short(number);
  }

  plots.forEach(plot => {
    const box = document.createElement("div");
    box.className = "chart tall";
    const canvas = document.createElement("canvas");
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", plot.title);
    box.appendChild(canvas);
    place.appendChild(box);
    if (plot.tornado) {
      new Chart(canvas, {
        type: "bar",
        data: { labels: plot.labels, datasets: plot.lines.map((line, i) =>
          ({ label: line.name, data: line.values, backgroundColor: colours[i % colours.length], grouped: false, barPercentage: .8 })) },
        options: { indexAxis: "y", plugins: { title: { display: true, text: plot.title } },
          scales: { x: axis(plot.x), y: { ticks: { autoSkip: false } } } }
      });
      return;
    }
    const numbers = plot.labels.map(Number);
    const numeric = !plot.bars && numbers.every(n => Number.isFinite(n));
    const x = axis(plot.x);
    if (numeric) x.type = plot.logarithmic ? "logarithmic" : "linear";
    if (x.type === "logarithmic") x.ticks = { callback: logarithmicTick };
    const datasets = plot.lines.map((line, i) => ({
      label: line.name,
      data: numeric ? line.values.map((value, point) => ({ x: numbers[point], y: value })) : line.values,
      borderColor: colours[i % colours.length],
      backgroundColor: colours[i % colours.length],
      pointRadius: 3, borderWidth: 2, tension: 0
    }));
    new Chart(canvas, {
      type: numeric ? "line" : "bar",
      data: numeric ? { datasets: datasets } : { labels: plot.labels, datasets: datasets },
      options: { plugins: { title: { display: true, text: plot.title } }, scales: { x: x, y: Object.assign({ beginAtZero: true }, axis(plot.y)) } }
    });
  });
}());
