// Draws the charts from the JSON in #data: {activities: [name], designs: [{id, cycles, on_chip, wrong_pixels,
// hazards: [h1..h4 as [concurrency, incoherence]],
// stalls: [{stage, fractions: [one per activity]}], bytes: {link: bytes per fragment}, distance: [hazards per bin]}]}.
(function () {
  "use strict";
  if (typeof Chart === "undefined") return;
  const data = JSON.parse(document.getElementById("data").textContent);
  const designs = data.designs;
  const names = designs.map(d => d.id);
  const place = document.querySelector("#charts .charts");
  document.getElementById("charts").hidden = false;
  Chart.defaults.animation = false;
  Chart.defaults.maintainAspectRatio = false;

  const hazardColours = ["#ff5c3c", "#e6b800", "#2fb4e0", "#d055e6"]; // those of hazards.png, darker for white paper
  const designColours = ["#3b6fb6", "#e08a2e", "#4c9a5b", "#b0457a", "#7a62b8", "#8a6d3b", "#4aa3a3", "#777c88"];
  const activityColours = { idle: "#e4e6eb", busy: "#4c9a5b", starved: "#b9c4d6", blocked: "#e0a23a", hazard: "#d64541", memory: "#5b7fc4" };
  const colourOf = index => designColours[index % designColours.length];

  function add(title, config, tall) {
    const box = document.createElement("div");
    box.className = tall ? "chart tall" : "chart";
    const canvas = document.createElement("canvas");
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", title);
    box.appendChild(canvas);
    place.appendChild(box);
    config.options = config.options || {};
    config.options.plugins = Object.assign({ title: { display: true, text: title } }, config.options.plugins);
    new Chart(canvas, config);
  }

  const stacked = (x, y) => ({ scales: { x: Object.assign({ stacked: true }, x), y: Object.assign({ stacked: true }, y) } });
  const axis = text => ({ title: { display: true, text: text } });

  add("Core cycles of the frame", {
    type: "bar",
    data: { labels: names, datasets: [{ data: designs.map(d => d.cycles), backgroundColor: names.map((n, i) => colourOf(i)) }] },
    options: { plugins: { legend: { display: false } }, scales: { y: axis("cycles") } }
  });

  // A class has one colour, full for concurrency and pale for incoherence.
  const classNames = ["H1 in flight", "H2 write path", "H3 stale line", "H4 torn read"];
  const kindNames = ["concurrency", "incoherence"];
  const hazardSets = [];
  kindNames.forEach((kindName, kind) => classNames.forEach((className, cause) => {
    const counts = designs.map(d => d.hazards[cause][kind]);
    if (counts.some(count => count > 0)) hazardSets.push({ label: className + ", " + kindName, data: counts,
      backgroundColor: hazardColours[cause] + (kind ? "70" : "") });
  }));
  if (hazardSets.length) add("Hazards by kind and class", {
    type: "bar",
    data: { labels: names, datasets: hazardSets },
    options: stacked({}, axis("fragments"))
  });

  if (designs.some(d => d.on_chip > 0)) add("Time and on-chip memory", {
    type: "scatter",
    data: { datasets: designs.map((d, i) => ({ label: d.id, data: [{ x: d.on_chip / 1024, y: d.cycles }], backgroundColor: colourOf(i), pointRadius: 6 })) },
    options: { scales: { x: axis("KiB on chip"), y: axis("cycles") } }
  });

  const links = [];
  designs.forEach(d => Object.keys(d.bytes).forEach(link => { if (!links.includes(link)) links.push(link); }));
  if (links.length) add("Bytes per fragment on each link", {
    type: "bar",
    data: { labels: links, datasets: designs.map((d, i) => ({ label: d.id, data: links.map(l => d.bytes[l] || 0), backgroundColor: colourOf(i) })) },
    options: { indexAxis: "y", scales: { x: axis("bytes per fragment"), y: { ticks: { autoSkip: false } } } }
  }, true);

  let bins = 0;
  designs.forEach(d => d.distance.forEach((count, bin) => { if (count) bins = Math.max(bins, bin + 1); }));
  if (bins) add("Hazards by distance", {
    type: "bar",
    data: { labels: Array.from({ length: bins }, (_, bin) => "\u2265 " + Math.pow(2, bin)),
      datasets: designs.map((d, i) => ({ label: d.id, data: d.distance.slice(0, bins), backgroundColor: colourOf(i) }))
        .filter(set => set.data.some(count => count > 0)) },
    options: { scales: { x: axis("quads between the two fragments"), y: axis("hazards") } }
  });

  designs.forEach(d => {
    if (!d.stalls.length) return;
    add("Where the time goes: " + d.id, {
      type: "bar",
      data: { labels: d.stalls.map(s => s.stage), datasets: data.activities.map((name, activity) =>
        ({ label: name, data: d.stalls.map(s => 100 * s.fractions[activity]), backgroundColor: activityColours[name] || "#888" })) },
      options: Object.assign({ indexAxis: "y" }, stacked(Object.assign({ max: 100 }, axis("percent of the time")), { ticks: { autoSkip: false } }))
    }, true);
  });
}());
