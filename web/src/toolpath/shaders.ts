// One program draws the whole path; done, executing and to come differ only by numbers that it is told each frame.

export const vertexShader = `
  in float line;
  in float kind;
  flat out float vLine;
  flat out float vKind;
  void main() {
    vLine = line;
    vKind = kind;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`;

export const fragmentShader = `
  precision highp float;
  uniform float doneBefore;
  uniform float nowUntil;
  uniform float marked;
  uniform vec3 rapidColour;
  uniform vec3 cutColour;
  uniform vec3 doneColour;
  uniform vec3 nowColour;
  uniform vec3 markColour;
  flat in float vLine;
  flat in float vKind;
  out vec4 colour;
  void main() {
    bool cut = vKind > 0.5 && vKind < 3.5;
    vec3 c = cut ? cutColour : rapidColour;
    if (vLine < doneBefore) c = cut ? doneColour : doneColour * 0.7 + rapidColour * 0.3;
    else if (vLine <= nowUntil) c = nowColour;
    if (marked > 0.5 && abs(vLine - marked) < 0.5) c = markColour;
    colour = vec4(c, cut ? 1.0 : 0.75);
  }
`;
