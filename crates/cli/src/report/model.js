(function () {
  var d = DATA, canvas = document.getElementById("model"), at = document.getElementById("model-at");
  var button = document.getElementById("model-play"), time = document.getElementById("model-time");
  var g = canvas.getContext("2d"), timer = null;
  var eye = [0.5625, -0.72, 0.4067], right = [0.788, 0.6157, 0], up = [-0.2505, 0.3206, 0.9135];
  function dot(a, b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  function cross(a, b) { return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]; }
  function turned(q, v) {
    var u = [q[1], q[2], q[3]], c = cross(u, v), cc = cross(u, c);
    return [0, 1, 2].map(function (k) { return v[k] + 2 * (q[0] * c[k] + cc[k]); });
  }
  function place(p) {
    var scale = 0.45 * canvas.height / d.reach;
    return [canvas.width / 2 + scale * dot(p, right), canvas.height / 2 - scale * dot(p, up)];
  }
  function line(p, colour, name) {
    var a = place([0, 0, 0]), b = place(p);
    g.strokeStyle = g.fillStyle = colour; g.lineWidth = 1.5;
    g.beginPath(); g.moveTo(a[0], a[1]); g.lineTo(b[0], b[1]); g.stroke();
    g.font = "14px Helvetica, Arial, sans-serif"; g.fillText(name, b[0] + 4, b[1] - 4);
  }
  function draw(i) {
    var q = d.attitudes[i];
    g.clearRect(0, 0, canvas.width, canvas.height);
    ["X", "Y", "Z"].forEach(function (name, k) {
      var p = [0, 0, 0]; p[k] = 0.95 * d.reach; line(p, "#9aa5b1", name);
    });
    d.faces.map(function (face) {
      var corners = face.corners.map(function (p) { return turned(q, p); });
      var middle = [0, 1, 2].map(function (k) { return (corners[0][k] + corners[2][k]) / 2; });
      return { corners: corners, depth: dot(middle, eye), front: dot(turned(q, face.normal), eye), colour: face.colour };
    }).filter(function (face) { return face.front > 0; }).sort(function (a, b) { return a.depth - b.depth; })
      .forEach(function (face) {
        g.beginPath();
        face.corners.map(place).forEach(function (p, k) { if (k) { g.lineTo(p[0], p[1]); } else { g.moveTo(p[0], p[1]); } });
        g.closePath();
        var light = 0.7 + 0.3 * face.front;
        g.fillStyle = "rgb(" + face.colour.map(function (own) { return Math.round(own * light); }).join(",") + ")";
        g.strokeStyle = "#1b2733"; g.lineWidth = 1; g.fill(); g.stroke();
      });
    ["x", "y", "z"].forEach(function (name, k) {
      var p = [0, 0, 0]; p[k] = 0.8 * d.reach; line(turned(q, p), ["#b3201f", "#00734f", "#005a92"][k], name);
    });
    time.textContent = d.times[i]; at.value = i;
  }
  function stop() { clearInterval(timer); timer = null; button.textContent = "Play"; }
  button.onclick = function () {
    if (timer) { stop(); return; }
    var i = +at.value >= d.times.length - 1 ? 0 : +at.value;
    button.textContent = "Stop";
    timer = setInterval(function () { draw(i); i += 1; if (i >= d.times.length) { stop(); } }, 40);
  };
  at.oninput = function () { if (timer) { stop(); } draw(+at.value); };
  draw(0);
})();
