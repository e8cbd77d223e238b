"use strict";
// Draws the figures of a page from its data. Each figure is a function of the data that gives plotly's
// traces and layout; the frame gives them the colours of the page.
(() => {
  const page = JSON.parse(document.getElementById("data").textContent);
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  let printing = false;

  // cmocean's balance: even in lightness on both sides of zero, and not of red against green.
  const BALANCE = [[23, 28, 66], [41, 58, 143], [11, 102, 189], [69, 144, 185], [142, 181, 194],
    [210, 216, 219], [230, 210, 204], [213, 157, 137], [196, 101, 72], [172, 43, 36], [120, 14, 40], [60, 9, 17]]
    .map((rgb, i, all) => [i / (all.length - 1), `rgb(${rgb.join(",")})`]);
  // After Okabe and Ito's colours, which colour-blind people can tell apart, for both backgrounds.
  const [BLUE, ORANGE, GREEN] = ["#2e86d1", "#d55e00", "#009e73"];
  // The part of the radius whose cells set the scale of a map.
  const INNER = 0.95;
  // Widths on paper, in pixels: two figures beside each other, and one alone.
  const PRINT = { half: 320, whole: 660 };
  // Height of a line of a label, in pixels.
  const LABEL = 12;
  const LIMIT = { color: "#cc79a7", dash: "dash", width: 2 };

  const numbers = (samples) => {
    const bytes = Uint8Array.from(atob(samples.bdata), (c) => c.charCodeAt(0));
    return Array.from(new Float32Array(bytes.buffer), (value) => (Number.isFinite(value) ? value : null));
  };
  const rowsOf = (values, width) => {
    const rows = [];
    for (let at = 0; at < values.length; at += width) rows.push(values.slice(at, at + width));
    return rows;
  };
  const known = (values) => values.filter((value) => value !== null).sort((a, b) => a - b);
  // The range of values without the share of the highest and lowest.
  const robust = (values, share) => {
    const sorted = known(values);
    if (sorted.length === 0) return [0, 1];
    const off = Math.floor(share * (sorted.length - 1));
    const [low, high] = [sorted[off], sorted[sorted.length - 1 - off]];
    return low < high ? [low, high] : [low - 0.5, high + 0.5];
  };
  // The values of a map off its rim, where a path may leave material of another scale.
  const offRim = (values, cells) => values.filter((_, i) => {
    const [x, y] = [(2 * (i % cells) + 1) / cells - 1, (2 * Math.floor(i / cells) + 1) / cells - 1];
    return x * x + y * y < INNER * INNER;
  });
  // Numbers that are too long have a power of ten.
  const POWERS = { exponentformat: "power", minexponent: 4 };
  const axis = (text, more) =>
    ({ title: { text }, automargin: true, zeroline: false, ...POWERS, ...more });
  const title = (text) => ({ text, side: "right", font: { size: 12 } });

  // A map on the square around the part; rows come from the largest y down.
  const map = (cells, half, values, bar, scale) => {
    const step = (2 * half) / cells;
    const places = Array.from({ length: cells }, (_, i) => -half + (i + 0.5) * step);
    return {
      traces: [{
        type: "heatmap", x: places, y: [...places].reverse(), z: rowsOf(values, cells), hoverongaps: false,
        colorbar: { title: title(bar), thickness: 12, len: 1, outlinewidth: 0, ...POWERS }, ...scale,
        hovertemplate: "x %{x:.4g} mm, y %{y:.4g} mm<br>%{z:.4g}<extra></extra>",
      }],
      layout: {
        xaxis: axis("x / mm", { constrain: "domain", showgrid: false }),
        yaxis: axis("y / mm", { scaleanchor: "x", constrain: "domain", showgrid: false }),
      },
    };
  };
  const line = (x, y, name, colour, more) => ({
    type: "scatter", mode: "lines", x, y, name, line: { color: colour, width: 1.5 }, connectgaps: false, ...more,
  });
  // Panels above each other on one x axis: [title of y, traces].
  const panels = (xTitle, all) => {
    const traces = [];
    const layout = { xaxis: axis(xTitle, { anchor: all.length > 1 ? `y${all.length}` : "y" }), showlegend: false };
    const gap = 0.06;
    const height = (1 - gap * (all.length - 1)) / all.length;
    all.forEach(([yTitle, own, more], i) => {
      const id = i === 0 ? "" : String(i + 1);
      const top = 1 - i * (height + gap);
      const most = own.flatMap((trace) => known(trace.y)).reduce((a, b) => Math.max(a, b), 0);
      // Below a millionth of any unit there is rounding alone.
      const range = [0, Math.max(1.1 * most, 1e-6)];
      layout[`yaxis${id}`] = axis(yTitle, { domain: [Math.max(0, top - height), top], range, nticks: 5, ...more });
      own.forEach((trace) => traces.push({ ...trace, xaxis: "x", yaxis: `y${id}` }));
    });
    return { traces, layout };
  };
  const level = (x, value, name) => line([x[0], x[x.length - 1]], [value, value], name, LIMIT.color, { line: LIMIT });
  const ends = (x) => { const sorted = known(x); return [sorted[0], sorted[sorted.length - 1]]; };

  const RUN = {
    "error-map": ({ sketch: { map: m } }) => {
      const values = numbers(m.error_nm);
      const [zmin, zmax] = robust(offRim(values, m.cells), 0.002);
      return map(m.cells, m.half_mm, values, "error / nm", { colorscale: "Cividis", zmin, zmax });
    },
    "radial-mean": ({ sketch: { radial_mean: mean } }) => ({
      traces: [line(numbers(mean.radius_mm), numbers(mean.error_nm), "mean", BLUE)],
      layout: { xaxis: axis("radius / mm"), yaxis: axis("mean error / nm") },
    }),
    "spectrum": ({ sketch, report }) => {
      const y = numbers(sketch.harmonics_nm).slice(1);
      const x = y.map((_, i) => i + 1);
      const layout = { xaxis: axis("periods a turn", { type: "log" }), yaxis: axis("amplitude / nm", { rangemode: "tozero" }), bargap: 0 };
      const spokes = report.spokes;
      if (spokes) {
        layout.annotations = [{
          x: Math.log10(spokes.per_turn), y: spokes.amplitude_nm, showarrow: true, arrowhead: 2, ax: 0, ay: -30,
          text: `${spokes.amplitude_nm.toPrecision(4)} nm, ${spokes.per_turn} a turn`,
        }];
        layout.yaxis.range = [0, 1.3 * Math.max(...y)];
      }
      const stems = { x: x.flatMap((k) => [k, k, null]), y: y.flatMap((a) => [0, a, null]) };
      return {
        traces: [
          { type: "scatter", mode: "lines", ...stems, line: { color: BLUE, width: 1 }, hoverinfo: "skip", showlegend: false },
          { type: "scatter", mode: "markers", x, y, marker: { color: BLUE, size: 4 }, name: "amplitude",
            hovertemplate: "%{x} a turn: %{y:.4g} nm<extra></extra>" },
        ],
        layout: { ...layout, showlegend: false },
      };
    },
    "profile": ({ sketch }) => ({
      traces: sketch.profiles.map((profile, i) => line(numbers(profile.s_mm), numbers(profile.error_nm),
        `${profile.angle_deg.toFixed(1)}°`, [BLUE, ORANGE, GREEN][i % 3])),
      layout: { xaxis: axis("s / mm"), yaxis: axis("error / nm"), legend: { orientation: "h", y: 1.12 } },
    }),
    "surface": ({ surface }) =>
      map(surface.cells, surface.half_mm, numbers(surface.height_um), "height / µm", { colorscale: "Viridis" }),
    "deviation": ({ surface }) => {
      const values = numbers(surface.deviation_um);
      const most = Math.max(1e-6, ...known(values).map(Math.abs));
      return map(surface.cells, surface.half_mm, values, "deviation / µm", { colorscale: BALANCE, zmin: -most, zmax: most });
    },
    "spiral": ({ sketch: { spiral } }) => {
      const errors = numbers(spiral.error_nm);
      const most = Math.max(1e-6, ...known(errors));
      return {
        traces: [{
          type: "scatter", mode: "markers", x: numbers(spiral.x_mm), y: numbers(spiral.y_mm), customdata: errors,
          marker: {
            size: 3, color: errors, colorscale: "Cividis", cmin: 0, cmax: most,
            colorbar: { title: title("error / nm"), thickness: 12, len: 1, outlinewidth: 0, ...POWERS },
          },
          hovertemplate: "x %{x:.4g} mm, y %{y:.4g} mm<br>%{customdata:.4g} nm<extra></extra>",
        }],
        layout: {
          xaxis: axis("x / mm", { constrain: "domain" }),
          yaxis: axis("y / mm", { scaleanchor: "x", constrain: "domain" }),
        },
      };
    },
    "along": ({ sketch: { turns }, report }) => {
      const r = numbers(turns.radius_mm);
      const tolerance = report.tolerance.interpolation_nm;
      const error = [line(r, numbers(turns.error_nm), "error", BLUE)];
      if (tolerance) error.push(level(ends(r), tolerance, "tolerance"));
      return panels("radius (mean X) / mm", [
        ["feed / µm/rev", [line(r, numbers(turns.feed_um_per_rev), "feed", BLUE)]],
        ["points a turn", [line(r, numbers(turns.points_per_turn), "points", BLUE)]],
        ["spindle / rpm", [line(r, numbers(turns.spindle_rpm), "spindle", BLUE)]],
        ["error / nm", error],
      ]);
    },
    "x-axis": (data) => motion(data, "x"),
    "z-axis": (data) => motion(data, "z"),
    "angle": ({ sketch: { edges }, report }) => {
      const angles = (values) => values.map((_, i) => (360 * i) / values.length);
      const curve = (samples, name, colour) => { const y = numbers(samples); return line(angles(y), y, name, colour); };
      const material = report.tolerance.residual_nm ?? report.tolerance.form_nm;
      const limit = material ? [level([0, 360], material, "tolerance")] : [];
      const uncut = [curve(edges.rim_nm, "rim", BLUE), curve(edges.hole_nm, "hole", ORANGE)];
      const both = panels("C / deg", [
        ["residual / nm", [{ ...curve(edges.residual_nm, "residual", GREEN), showlegend: false },
          ...limit.map((trace) => ({ ...trace, showlegend: false }))]],
        ["uncut / nm", [...uncut.filter((trace) => trace.x.length > 0), ...limit]],
      ]);
      both.layout.showlegend = true;
      both.layout.legend = { orientation: "h", y: 1.08 };
      both.layout.xaxis.dtick = 90;
      return both;
    },
  };
  const motion = ({ sketch: { turns }, report }, name) => {
    const r = numbers(turns.radius_mm);
    const limits = report.machine ? report.machine.limits : [];
    const rows = [["velocity", "mm/s", "velocity_mm_per_s", "limit_mm_per_s"],
      ["acceleration", "mm/s²", "acceleration_mm_per_s2", "limit_mm_per_s2"],
      ["jerk", "mm/s³", "jerk_mm_per_s3", "limit_mm_per_s3"]];
    return panels("radius (mean X) / mm", rows.map(([word, unit, key, limitKey]) => {
      const traces = [line(r, numbers(turns[name][key]), word, BLUE)];
      const limit = limits.find((one) => one.limit === `${name}_${word}`);
      if (limit) traces.push(level(ends(r), limit[limitKey], "limit"));
      return [`${word} / ${unit}`, traces];
    }));
  };

  const theme = () => {
    const isDark = dark.matches && !printing;
    const front = isDark ? "#e4e7eb" : "#1b1f24";
    const grid = isDark ? "#39414a" : "#dfe3e8";
    return { front, grid };
  };
  const sized = (layout, place) => {
    if (!printing) return { ...layout, width: undefined, autosize: true };
    return { ...layout, width: place.closest("figure.whole") ? PRINT.whole : PRINT.half, autosize: false };
  };
  const themed = (layout) => {
    const { front, grid } = theme();
    const own = { ...layout, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", font: { color: front, size: 12 },
      margin: { l: 8, r: 8, t: 12, b: 8, ...layout.margin } };
    for (const key of Object.keys(own))
      if (/^[xy]axis/.test(key)) own[key] = { gridcolor: grid, linecolor: grid, tickcolor: grid, ...own[key] };
    if (own.annotations) own.annotations = own.annotations.map((one) => ({ font: { color: front, size: 11 }, arrowcolor: front, ...one }));
    return own;
  };
  // Without a pointer that hovers, the buttons would always lie over the figures.
  const hovers = window.matchMedia("(hover: hover)").matches;
  const config = { responsive: true, displaylogo: false, displayModeBar: hovers ? "hover" : false,
    modeBarButtonsToRemove: ["lasso2d", "select2d"] };

  const drawn = new Map();
  const draw = async (id, make) => {
    const place = document.getElementById(id);
    if (!place) return;
    const figure = make(page, place);
    drawn.set(id, figure);
    await Plotly.newPlot(place, figure.traces, themed(figure.layout), config);
  };
  const redraw = () => {
    for (const [id, figure] of drawn) {
      const place = document.getElementById(id);
      Plotly.react(place, figure.traces, themed(sized(figure.layout, place)), config);
    }
  };

  const ABLATION = {
    "points-error": (data) => front(data, "points-error"),
    "time-acceleration": (data) => front(data, "time-acceleration"),
    "error-maps": tiles,
    "radial-means": ({ runs }) => ({
      traces: overlaid(runs, ({ radial_mean: mean }) => mean && [numbers(mean.radius_mm), numbers(mean.error_nm)]),
      layout: { xaxis: axis("radius / mm"), yaxis: axis("mean error / nm"), showlegend: false },
    }),
    "spectra": ({ runs }) => ({
      traces: overlaid(runs, ({ harmonics_nm: harmonics }) => {
        const y = numbers(harmonics).slice(1);
        return [y.map((_, i) => i + 1), y];
      }),
      layout: { xaxis: axis("periods a turn", { type: "log" }), yaxis: axis("amplitude / nm", { type: "log" }), showlegend: false },
    }),
  };
  // Shades from dark to light that stay apart in grey.
  const shade = (share) => `hsl(${260 - 200 * share}, 70%, ${35 + 25 * share}%)`;
  function overlaid(runs, curve) {
    return runs.flatMap(({ name, sketch }, i) => {
      const xy = sketch && curve(sketch);
      if (!xy || xy[0].length === 0) return [];
      const colour = shade(i / Math.max(1, runs.length - 1));
      return [line(xy[0], xy[1], plain(name), colour, { line: { color: colour, width: 1 } })];
    });
  }
  // plotly takes some tags in names as its own.
  function plain(text) {
    return text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");
  }
  function front({ runs, comparisons }, id) {
    const { places, front: indices, x_title: x, y_title: y } = comparisons.find((one) => one.id === id);
    const all = places.map((_, i) => i).filter((i) => places[i]);
    // Figures that lie far apart are told apart on a logarithmic axis only.
    const spread = (which) => {
      const values = all.map((i) => places[i][which]);
      const [least, most] = [Math.min(...values), Math.max(...values)];
      return least > 0 && most > 30 * least ? { type: "log" } : { rangemode: "tozero" };
    };
    const points = (from, more) => ({
      type: "scatter", x: from.map((i) => places[i][0]), y: from.map((i) => places[i][1]),
      text: from.map((i) => plain(runs[i].name)), hovertemplate: "%{text}<br>%{x:.5g}, %{y:.4g}<extra></extra>", ...more,
    });
    return {
      traces: [
        points(all, { mode: "markers", name: "run", marker: { color: BLUE, size: 7, opacity: 0.7 } }),
        points(indices, { mode: "lines+markers", name: "front", line: { color: ORANGE, width: 1.5, shape: "hv" },
          marker: { color: ORANGE, size: 9, symbol: "diamond" } }),
      ],
      layout: { xaxis: axis(x, spread(0)), yaxis: axis(y, spread(1)), legend: { orientation: "h", y: 1.12 } },
    };
  }
  // All maps as tiles of one picture, so that they share one scale.
  function tiles({ runs }, place) {
    const shown = runs.filter(({ sketch }) => sketch && sketch.map);
    const wide = place.clientWidth || 800;
    const columns = Math.max(1, Math.min(shown.length, Math.floor((wide - 90) / 150)));
    const size = Math.max(0, ...shown.map(({ sketch }) => sketch.map.cells));
    const tile = (wide - 90) / columns;
    // Each label has a line for each value that varies.
    const parts = shown.map(({ values }) => (values.length > 3 ? [values.join(", ")] : values));
    const lines = Math.max(1, ...parts.map((values) => values.length));
    const gap = Math.ceil((size * (LABEL * lines + 6)) / (tile - LABEL * lines - 6));
    const pitch = size + gap;
    const rows = Math.ceil(shown.length / columns);
    const z = Array.from({ length: rows * pitch }, () => new Array(columns * pitch).fill(null));
    const annotations = [];
    const every = [];
    shown.forEach(({ name, sketch }, i) => {
      const [row, column] = [Math.floor(i / columns), i % columns];
      const values = numbers(sketch.map.error_nm);
      every.push(offRim(values, sketch.map.cells));
      rowsOf(values, sketch.map.cells).forEach((own, y) => {
        own.forEach((value, x) => { z[row * pitch + gap + y][column * pitch + x] = value; });
      });
      const letters = Math.floor(tile / 6);
      const short = (text) => plain(text.length > letters ? `${text.slice(0, letters - 1)}…` : text);
      annotations.push({ x: column * pitch, y: row * pitch + gap, xanchor: "left", yanchor: "bottom", showarrow: false,
        align: "left", text: parts[i].map(short).join("<br>"), hovertext: plain(name), font: { size: 10 } });
    });
    const [zmin, zmax] = robust(every.flat(), 0.05);
    place.style.height = `${Math.ceil(rows * tile + 30)}px`;
    return {
      traces: [{ type: "heatmap", z, colorscale: "Cividis", zmin, zmax, hoverongaps: false, hovertemplate: "%{z:.4g} nm<extra></extra>",
        colorbar: { title: title("error / nm"), thickness: 12, len: Math.min(300, rows * tile), lenmode: "pixels", y: 1, yanchor: "top", outlinewidth: 0, ...POWERS } }],
      layout: {
        annotations, dragmode: "zoom",
        xaxis: { visible: false, constrain: "domain" },
        yaxis: { visible: false, autorange: "reversed", scaleanchor: "x", constrain: "domain" },
      },
      tiles: { shown: shown.map(({ name }) => name), columns, pitch, gap, size },
    };
  }

  // A click on a heading sorts the runs by it; another one turns the order round.
  const sortable = (table) => {
    const heads = [...table.tHead.rows[0].cells];
    const sortBy = (column) => {
      const head = heads[column];
      const up = head.getAttribute("aria-sort") !== "ascending";
      heads.forEach((one) => one.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", up ? "ascending" : "descending");
      const value = (row) => {
        const cell = row.cells[column];
        if (!cell || cell.colSpan > 1) return null;
        if (cell.dataset.value !== undefined) return Number(cell.dataset.value);
        return cell.classList.contains("number") ? null : cell.textContent;
      };
      const rows = [...table.tBodies[0].rows].map((row, place) => ({ row, place, key: value(row) }));
      const order = (a, b) => {
        // Runs without a figure stay at the end.
        if (a.key === null || b.key === null) return (a.key === null) - (b.key === null) || a.place - b.place;
        const less = typeof a.key === "number" && typeof b.key === "number"
          ? a.key - b.key : String(a.key).localeCompare(String(b.key), "en", { numeric: true });
        return (up ? less : -less) || a.place - b.place;
      };
      table.tBodies[0].append(...rows.sort(order).map(({ row }) => row));
    };
    heads.forEach((head, column) => {
      head.addEventListener("click", () => sortBy(column));
      head.addEventListener("keydown", (event) => { if (event.key === "Enter") sortBy(column); });
    });
  };
  document.querySelectorAll("table.runs").forEach(sortable);

  const all = { run: RUN, ablation: ABLATION }[page.kind] ?? {};
  (async () => {
    for (const [id, make] of Object.entries(all)) await draw(id, make);
    dark.addEventListener("change", redraw);
    window.addEventListener("beforeprint", () => { printing = true; redraw(); });
    window.addEventListener("afterprint", () => { printing = false; redraw(); });
    document.documentElement.dataset.drawn = String(drawn.size);
  })();
})();
