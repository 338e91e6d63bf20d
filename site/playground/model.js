// The spacecraft as a turning model, from the glTF file that the engine writes. Loaded when it is first wanted.

import { AmbientLight, AnimationMixer, Box3, DirectionalLight, PerspectiveCamera, Scene, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { GLTFLoader } from "three/examples/jsm/loaders/GLTFLoader.js";

// Shows a model in an element; returns a function that removes it.
async function show(parent, bytes) {
  const model = await new GLTFLoader().parseAsync(bytes.buffer, "");
  const renderer = new WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
  const [width, height] = [parent.clientWidth || 400, 360];
  renderer.setSize(width, height);
  renderer.setPixelRatio(globalThis.devicePixelRatio);
  const scene = new Scene();
  const light = new DirectionalLight(0xffffff, 2.5);
  light.position.set(2, 3, 4);
  scene.add(new AmbientLight(0xffffff, 1.2), light, model.scene);
  const box = new Box3().setFromObject(model.scene);
  const [centre, reach] = [box.getCenter(new Vector3()), box.getSize(new Vector3()).length()];
  const camera = new PerspectiveCamera(35, width / height, reach / 100, reach * 100);
  camera.position.copy(centre).add(new Vector3(0.8, 0.6, 1).multiplyScalar(reach));
  const controls = new OrbitControls(camera, renderer.domElement);
  controls.target.copy(centre);
  const mixer = new AnimationMixer(model.scene);
  const clips = model.animations.map((clip) => mixer.clipAction(clip));
  const duration = Math.max(0, ...model.animations.map((clip) => clip.duration));
  clips.forEach((action) => action.play());

  const bar = document.createElement("div");
  bar.className = "player";
  const play = document.createElement("button");
  const cursor = document.createElement("input");
  Object.assign(cursor, { type: "range", min: 0, max: 1000, value: 0 });
  cursor.setAttribute("aria-label", "time");
  let isPlaying = false;
  const label = () => (play.textContent = isPlaying ? "Pause" : "Play");
  play.onclick = () => {
    isPlaying = !isPlaying;
    label();
  };
  cursor.oninput = () => mixer.setTime((Number(cursor.value) / 1000) * duration);
  label();
  bar.append(play, cursor);
  parent.replaceChildren(renderer.domElement, ...(duration > 0 ? [bar] : []));

  let before = performance.now();
  renderer.setAnimationLoop((now) => {
    const step = Math.max(0, now - before) / 1000;
    before = now;
    if (isPlaying && duration > 0) {
      mixer.update(step);
      cursor.value = ((mixer.time % duration) / duration) * 1000;
    }
    controls.update();
    renderer.render(scene, camera);
  });
  return () => {
    renderer.setAnimationLoop(null);
    renderer.dispose();
  };
}

globalThis.FLEXSC_MODEL = { show };
