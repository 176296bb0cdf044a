// Stand-ins of the few Unity types that packaging/unity uses, so that its components compile and run under Mono. They are not Unity: transforms have no scale but their own,
// only SetActive, Destroy and AddComponent send messages, and colliders are fields.
using System;
using System.Collections.Generic;
using System.Reflection;

namespace UnityEngine {
    public struct Vector3 {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
        public static Vector3 zero => new Vector3(0, 0, 0);
        public static Vector3 operator +(Vector3 a, Vector3 b) => new Vector3(a.x + b.x, a.y + b.y, a.z + b.z);
        public static Vector3 operator -(Vector3 a, Vector3 b) => new Vector3(a.x - b.x, a.y - b.y, a.z - b.z);
        public static bool operator ==(Vector3 a, Vector3 b) => a.x == b.x && a.y == b.y && a.z == b.z;
        public static bool operator !=(Vector3 a, Vector3 b) => !(a == b);
        public override bool Equals(object other) => other is Vector3 && this == (Vector3)other;
        public override int GetHashCode() => 0;
    }
    public struct Quaternion {
        public float x, y, z, w;
        public Quaternion(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
        public static Quaternion Inverse(Quaternion q) => new Quaternion(-q.x, -q.y, -q.z, q.w);
        public static Quaternion operator *(Quaternion a, Quaternion b) => new Quaternion(
            a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z);
        public static Vector3 operator *(Quaternion q, Vector3 v) {
            Quaternion turned = q * new Quaternion(v.x, v.y, v.z, 0) * Inverse(q);
            return new Vector3(turned.x, turned.y, turned.z);
        }
    }
    public class Component {
        public GameObject gameObject;
        public string name => "an object";
        public Transform transform => gameObject.transform;
        public T GetComponent<T>() where T : class => gameObject.Find<T>();
    }
    public sealed class Transform : Component {
        public Transform parent;
        public Vector3 localPosition;
        public Quaternion localRotation = new Quaternion(0, 0, 0, 1);
        public Vector3 localScale = new Vector3(1, 1, 1);
        public Vector3 lossyScale => localScale;
        public Vector3 position {
            get { return parent == null ? localPosition : parent.position + parent.rotation * localPosition; }
            set { localPosition = parent == null ? value : Quaternion.Inverse(parent.rotation) * (value - parent.position); }
        }
        public Quaternion rotation {
            get { return parent == null ? localRotation : parent.rotation * localRotation; }
            set { localRotation = parent == null ? value : Quaternion.Inverse(parent.rotation) * value; }
        }
        public void SetPositionAndRotation(Vector3 at, Quaternion turned) { position = at; rotation = turned; }
    }
    public class MonoBehaviour : Component { }
    public class Collider : Component { }
    public sealed class BoxCollider : Collider { public Vector3 center, size = new Vector3(1, 1, 1); }
    public sealed class SphereCollider : Collider { public Vector3 center = Vector3.zero; public float radius = 0.5f; }
    public sealed class CapsuleCollider : Collider { public Vector3 center = Vector3.zero; public float radius = 0.5f, height = 2.0f; public int direction = 1; }
    public sealed class MeshCollider : Collider { public Mesh sharedMesh = null; public bool convex = false; }
    public sealed class Mesh { public Vector3[] vertices = null; public int[] triangles = null; public bool isReadable = true; }
    // Names that a binding must leave to Unity.
    public struct Pose { }
    public class Joint : Component { }
    public class Event { }
    public enum Space { World, Self }
    public enum PrimitiveType { Cube }
    public static class Time { public static float fixedDeltaTime = 1.0f / 90.0f, deltaTime = 1.0f / 90.0f, unscaledDeltaTime = 1.0f / 90.0f; }
    public static class Debug {
        public static readonly List<string> Errors = new List<string>();
        public static void Log(string text) { }
        public static void LogError(string text) { Errors.Add(text); }
    }
    [AttributeUsage(AttributeTargets.Class)]
    public sealed class DefaultExecutionOrderAttribute : Attribute { public DefaultExecutionOrderAttribute(int order) { } }

    public sealed class GameObject {
        public readonly Transform transform;
        private readonly List<Component> components = new List<Component>();
        private bool isActive = true;
        public GameObject(string name) { transform = new Transform { gameObject = this }; }
        public static GameObject CreatePrimitive(PrimitiveType type) {
            GameObject made = new GameObject("Cube");
            made.AddComponent<BoxCollider>();
            return made;
        }
        public T AddComponent<T>() where T : Component, new() {
            T made = new T { gameObject = this };
            components.Add(made);
            Send(made, "Awake");
            if (isActive) {
                Send(made, "OnEnable");
            }
            return made;
        }
        internal T Find<T>() where T : class => components.Find(one => one is T) as T;
        public void SetActive(bool active) {
            isActive = active;
            if (active) {
                components.ForEach(one => Send(one, "OnEnable"));
            } else {
                components.ForEach(one => Send(one, "OnDisable"));
            }
        }
        public void Destroy() {
            SetActive(false);
            components.ForEach(one => Send(one, "OnDestroy"));
        }
        public static void Send(Component to, string message) {
            MethodInfo method = to.GetType().GetMethod(message, BindingFlags.Instance | BindingFlags.NonPublic | BindingFlags.Public);
            if (method != null) {
                try {
                    method.Invoke(to, null);
                } catch (TargetInvocationException error) {
                    throw error.InnerException;
                }
            }
        }
    }
}
namespace AOT {
    [AttributeUsage(AttributeTargets.Method)]
    public sealed class MonoPInvokeCallbackAttribute : Attribute { public MonoPInvokeCallbackAttribute(Type type) { } }
}
