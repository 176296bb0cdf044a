// Stand-ins of the few Unity types that packaging/unity uses, so that its components compile and run under Mono. They have no behaviour but fields.
using System;
using System.Collections.Generic;
using System.Reflection;

namespace UnityEngine {
    public struct Vector3 {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
        public static Vector3 zero => new Vector3(0, 0, 0);
        public static bool operator ==(Vector3 a, Vector3 b) => a.x == b.x && a.y == b.y && a.z == b.z;
        public static bool operator !=(Vector3 a, Vector3 b) => !(a == b);
        public override bool Equals(object other) => other is Vector3 && this == (Vector3)other;
        public override int GetHashCode() => 0;
    }
    public struct Quaternion {
        public float x, y, z, w;
        public Quaternion(float x, float y, float z, float w) { this.x = x; this.y = y; this.z = z; this.w = w; }
    }
    public class Component {
        public GameObject gameObject;
        public string name => "an object";
        public Transform transform => gameObject.transform;
        public T GetComponent<T>() where T : class => gameObject.Find<T>();
    }
    public sealed class Transform : Component {
        public Vector3 position, localPosition;
        public Quaternion rotation = new Quaternion(0, 0, 0, 1), localRotation = new Quaternion(0, 0, 0, 1);
        public Vector3 localScale = new Vector3(1, 1, 1);
        public Vector3 lossyScale => localScale;
        public void SetPositionAndRotation(Vector3 at, Quaternion turned) { position = at; rotation = turned; }
    }
    public class MonoBehaviour : Component { }
    public class Collider : Component { }
    public sealed class BoxCollider : Collider { public Vector3 center, size = new Vector3(1, 1, 1); }
    public sealed class SphereCollider : Collider { public Vector3 center = Vector3.zero; public float radius = 0.5f; }
    public sealed class CapsuleCollider : Collider { public Vector3 center = Vector3.zero; public float radius = 0.5f, height = 2.0f; public int direction = 1; }
    public sealed class MeshCollider : Collider { public Mesh sharedMesh = null; }
    public sealed class Mesh { public Vector3[] vertices = null; public int[] triangles = null; }
    public enum PrimitiveType { Cube }
    public static class Time { public static float fixedDeltaTime = 1.0f / 90.0f; }
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
            }
        }
        public static void Send(Component to, string message) {
            MethodInfo method = to.GetType().GetMethod(message, BindingFlags.Instance | BindingFlags.NonPublic | BindingFlags.Public);
            if (method != null) {
                method.Invoke(to, null);
            }
        }
    }
}
namespace AOT {
    [AttributeUsage(AttributeTargets.Method)]
    public sealed class MonoPInvokeCallbackAttribute : Attribute { public MonoPInvokeCallbackAttribute(Type type) { } }
}
