// The points of a depth image, unprojected on the graphics card: a frame costs the upload of its two images.
import * as THREE from "three";

export const MAX_BOXES = 32;

const VERTEX = `
  precision highp usampler2D;
  uniform usampler2D depth;      // Millimetres; 0: no reading.
  uniform sampler2D color;
  uniform vec4 intrinsics;       // fx fy cx cy
  uniform ivec2 size;
  uniform int mode;              // 0 colour, 1 distance, 2 objects
  uniform bool hasColor;
  uniform float pointSize;
  uniform mat4 supportOfCamera;  // z: height above the table
  uniform bool hasSupport;
  uniform int boxes;
  uniform vec4 box[${MAX_BOXES}];       // u0 v0 u1 v1
  uniform vec3 boxColor[${MAX_BOXES}];
  out vec3 shade;

  vec3 distanceColor(float z) {
    float t = clamp((z - 0.4) / 1.6, 0.0, 1.0);
    return mix(vec3(0.95, 0.75, 0.45), vec3(0.18, 0.30, 0.55), t);
  }

  void main() {
    ivec2 pixel = ivec2(gl_VertexID % size.x, gl_VertexID / size.x);
    float z = float(texelFetch(depth, pixel, 0).r) * 0.001;
    if (z == 0.0) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); gl_PointSize = 0.0; return; }
    vec4 point = vec4((vec2(pixel) - intrinsics.zw) / intrinsics.xy * z, z, 1.0);
    vec3 base = hasColor ? texelFetch(color, pixel, 0).rgb : distanceColor(z);
    shade = mode == 1 ? distanceColor(z) : base;
    if (mode == 2) {
      shade = vec3(dot(base, vec3(0.3, 0.59, 0.11))) * 0.55;
      float height = hasSupport ? (supportOfCamera * point).z : 1.0;
      for (int i = 0; i < boxes; ++i)
        if (height > 0.008 && pixel.x >= int(box[i].x) && pixel.y >= int(box[i].y) && pixel.x < int(box[i].z) && pixel.y < int(box[i].w)) shade = boxColor[i];
    }
    vec4 seen = modelViewMatrix * point;
    gl_Position = projectionMatrix * seen;
    gl_PointSize = clamp(pointSize / -seen.z, 1.0, 6.0);
  }`;

const FRAGMENT = `
  in vec3 shade;
  out vec4 fragment;
  void main() { fragment = vec4(shade, 1.0); }`;

function texture(data, width, height, format, type, internalFormat) {
  const made = new THREE.DataTexture(data, width, height, format, type);
  made.internalFormat = internalFormat;
  made.minFilter = made.magFilter = THREE.NearestFilter;
  made.unpackAlignment = 1;
  made.needsUpdate = true;
  return made;
}

export class Cloud {
  constructor() {
    this.material = new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT,
      uniforms: {
        depth: { value: null }, color: { value: null }, intrinsics: { value: new THREE.Vector4() }, size: { value: new THREE.Vector2() }, mode: { value: 0 }, hasColor: { value: false },
        pointSize: { value: 1.5 }, supportOfCamera: { value: new THREE.Matrix4() }, hasSupport: { value: false }, boxes: { value: 0 },
        box: { value: Array.from({ length: MAX_BOXES }, () => new THREE.Vector4()) }, boxColor: { value: Array.from({ length: MAX_BOXES }, () => new THREE.Vector3()) },
      },
    });
    this.points = new THREE.Points(new THREE.BufferGeometry(), this.material);
    this.points.frustumCulled = false;
    this.points.visible = false;
    this.material.uniforms.color.value = texture(new Uint8Array(4), 1, 1, THREE.RGBAFormat, THREE.UnsignedByteType, "RGBA8");
  }

  setCalibration(calibration) {
    const k = calibration.K;
    this.material.uniforms.intrinsics.value.set(k[0], k[4], k[2], k[5]);
    this.isCalibrated = true;
  }

  get isReady() {
    return Boolean(this.isCalibrated && this.hasDepth);
  }

  /** What comes next is another sensor's. */
  reset() {
    this.isCalibrated = this.hasDepth = this.material.uniforms.hasColor.value = false;
  }

  setDepth(image) {
    const { width, height, data } = image;
    const words = data.byteOffset % 2 === 0 ? new Uint16Array(data.buffer, data.byteOffset, width * height) : new Uint16Array(data.slice().buffer);
    const uniforms = this.material.uniforms;
    const old = uniforms.depth.value;
    if (old && old.image.width === width && old.image.height === height) {
      old.image.data = words;
      old.needsUpdate = true;
    } else {
      old?.dispose();
      uniforms.depth.value = texture(words, width, height, THREE.RedIntegerFormat, THREE.UnsignedShortType, "R16UI");
      uniforms.size.value.set(width, height);
      // No attribute is read: the shader counts. Three wants one to know how many points there are.
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * width * height), 3));
      this.points.geometry.dispose();
      this.points.geometry = geometry;
    }
    this.hasDepth = true;
  }

  setColor(image) {
    const { width, height, data } = image;
    const rgba = this.rgba?.length === 4 * width * height ? this.rgba : (this.rgba = new Uint8Array(4 * width * height).fill(255));
    for (let i = 0, o = 0; i < data.length; i += 3, o += 4) {
      rgba[o] = data[i];
      rgba[o + 1] = data[i + 1];
      rgba[o + 2] = data[i + 2];
    }
    const uniforms = this.material.uniforms, old = uniforms.color.value;
    if (old.image.width === width && old.image.height === height) old.needsUpdate = true;
    else {
      old.dispose();
      uniforms.color.value = texture(rgba, width, height, THREE.RGBAFormat, THREE.UnsignedByteType, "RGBA8");
    }
    uniforms.hasColor.value = true;
  }

  /** Which pixels belong to objects: [{box: [u0, v0, u1, v1], color}], and where the table is. */
  setObjects(objects, supportOfCamera) {
    const uniforms = this.material.uniforms;
    uniforms.boxes.value = Math.min(MAX_BOXES, objects.length);
    objects.slice(0, MAX_BOXES).forEach(({ box, color }, i) => {
      uniforms.box.value[i].fromArray(box);
      uniforms.boxColor.value[i].fromArray(color);
    });
    uniforms.hasSupport.value = supportOfCamera !== null;
    if (supportOfCamera) uniforms.supportOfCamera.value.copy(supportOfCamera);
  }

  setMode(mode) {
    this.material.uniforms.mode.value = { colour: 0, distance: 1, objects: 2 }[mode];
  }
}
