// SPDX-License-Identifier: Apache-2.0
// Places the boards, the tool and the force's arrow: everything except the sand.
layout(location = 0) in vec3 aPosition;
layout(location = 1) in vec3 aNormal;
layout(location = 2) in vec2 aAlong;

uniform mat4 uSceneToRoom;
uniform mat4 uRoomToClip;
uniform vec4 uModel;  // the model's place and its scale

out vec3 vScene;
out vec3 vNormal;
out vec2 vAlong;

void main() {
    vScene = uModel.xyz + uModel.w * aPosition;
    vNormal = aNormal;
    vAlong = aAlong;
    vec4 room = uSceneToRoom * vec4(vScene, 1.0);
    gl_Position = uRoomToClip * room;
}
