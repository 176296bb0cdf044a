using UnityEngine;

namespace Handhold {
    /// <summary>Unity's vectors, rotations and poses (left-handed, metres) from and to Handhold's (right-handed).</summary>
    public static class UnityConvert {
        private const Engine Unity = Engine.Unity;

        public static Vec3 FromUnity(Vector3 v) => Library.ConvertVectorFrom(Unity, new Vec3(v.x, v.y, v.z));
        public static Vector3 ToUnity(Vec3 v) {
            Vec3 made = Library.ConvertVectorTo(Unity, v);
            return new Vector3((float)made.x, (float)made.y, (float)made.z);
        }
        public static Quat FromUnity(Quaternion q) => Library.ConvertRotationFrom(Unity, Unit(new Quat(q.x, q.y, q.z, q.w)));
        public static Quaternion ToUnity(Quat q) {
            Quat made = Library.ConvertRotationTo(Unity, q);
            return new Quaternion((float)made.x, (float)made.y, (float)made.z, (float)made.w);
        }
        public static HhPose FromUnity(Vector3 position, Quaternion rotation) => new HhPose(FromUnity(position), FromUnity(rotation));
        /// <summary>Angular velocities, rad/s.</summary>
        public static Vec3 AngularFromUnity(Vector3 v) => Library.ConvertAngularFrom(Unity, new Vec3(v.x, v.y, v.z));
        public static Vector3 AngularToUnity(Vec3 v) {
            Vec3 made = Library.ConvertAngularTo(Unity, v);
            return new Vector3((float)made.x, (float)made.y, (float)made.z);
        }

        // Floats leave a rotation of length 1 only to seven digits. The library refuses a zero or NaN rotation and counts it.
        private static Quat Unit(Quat q) {
            double length = System.Math.Sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
            return length > 0.0 ? new Quat(q.x / length, q.y / length, q.z / length, q.w / length) : q;
        }
    }
}
