#if UNITY_5_3_OR_NEWER
using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Events;

namespace Morec
{
    /// <summary>A motion of the performer; times in seconds of Time.timeAsDouble.</summary>
    [Serializable]
    public struct RecognisedMotion
    {
        public string name;
        /// <summary>Number of the motion, shared by its start, updates and end.</summary>
        public ulong number;
        /// <summary>Probability that the detection is right, 0 to 1. The lowest accepted score is 0.05 to 0.44, depending on the
        /// index. For held poses and indexes without calibration (svrdm, older files) it is the similarity to a sample instead.
        /// Of a tentative event: how near what was seen so far is to the beginning of a sample, 0 to 1.</summary>
        public double score;
        public double progress, startSecs, stopSecs;
        /// <summary>Time of the frame that caused the event, and the wall clock then, seconds since 1970.</summary>
        public double reportedSecs, wallSecs;
        /// <summary>Number of the event, from 1.</summary>
        public ulong sequence;
        /// <summary>Repetitions of an activity so far; 0 if nothing is counted.</summary>
        public uint repetitions;
        /// <summary>Duration of the last repetition, seconds.</summary>
        public double periodSecs;
        /// <summary>With Deviation: mean angle off the nearest sample, degrees; -1 where nothing is compared.</summary>
        public double offDegrees;
        /// <summary>Duration over the sample's, so far, and the largest angle of the bone that is farthest off.</summary>
        public double pace, worstDegrees;
        /// <summary>Number of that bone: see morec_bone_name.</summary>
        public uint worstBone;
    }

    [Serializable]
    public sealed class MotionUnityEvent : UnityEvent<RecognisedMotion> { }

    /// <summary>Recognises the motions of a humanoid, or of the given transforms, in every frame.</summary>
    [AddComponentMenu("morec/Morec Recognizer")]
    public sealed class MorecRecognizer : MonoBehaviour
    {
        public MorecIndexAsset index;
        [Tooltip("A humanoid whose bones are the joints; its own if none is given.")]
        public Animator animator;
        [Tooltip("Instead of a humanoid: a transform for each part of the body, in the order of MorecRole; empty where there is none.")]
        public Transform[] joints = new Transform[0];
        [Tooltip("Instead of a body: one or both hands, each the transform that its joints lie under, named as XR Hands and OpenXR name them.")]
        public Transform[] hands = new Transform[0];
        [Tooltip("Accepted false alarms a minute in background motion: 0.1 is strict, 1 is generous; 0: as trained.")]
        [Range(0, 1)] public float sensitivity;
        [Tooltip("The expected performer: decided automatically, the training subject, or anyone.")]
        public Performer performer;
        [Tooltip("Also report what seems to be under way: onStart, onUpdate, onCancel.")]
        public bool tentative;
        [Tooltip("Also report each repetition of an activity: onRepetition.")]
        public bool eachRepetition;
        [Tooltip("Say how far from the nearest sample each gesture that ends, and each repetition, was.")]
        public bool deviation;
        [Tooltip("Say with each frame how far every class has come: onProgress, whose progress and score are how far and how like, 0 to 1.")]
        public bool progress;
        [Tooltip("A motion of the same class that ends less than this after the one before it is not reported, seconds.")]
        [Min(0)] public float refractorySecs;
        [Tooltip("Final: every motion ends once, and nothing is taken back.")]
        public MotionUnityEvent onEnd = new MotionUnityEvent();
        [Tooltip("Tentative: something seems to be under way. Only with Tentative.")]
        public MotionUnityEvent onStart = new MotionUnityEvent();
        public MotionUnityEvent onUpdate = new MotionUnityEvent();
        public MotionUnityEvent onCancel = new MotionUnityEvent();
        [Tooltip("One more repetition of an activity is over. Only with Each Repetition.")]
        public MotionUnityEvent onRepetition = new MotionUnityEvent();
        [Tooltip("How far one class has come. Only with Progress.")]
        public MotionUnityEvent onProgress = new MotionUnityEvent();

        /// <summary>Bones of a humanoid in the order of MorecRole.</summary>
        static readonly HumanBodyBones[] Bones =
        {
            HumanBodyBones.Hips,
            HumanBodyBones.LeftUpperLeg, HumanBodyBones.LeftLowerLeg, HumanBodyBones.LeftFoot,
            HumanBodyBones.RightUpperLeg, HumanBodyBones.RightLowerLeg, HumanBodyBones.RightFoot,
            HumanBodyBones.Spine, HumanBodyBones.Neck, HumanBodyBones.Head,
            HumanBodyBones.LeftShoulder, HumanBodyBones.LeftUpperArm, HumanBodyBones.LeftLowerArm, HumanBodyBones.LeftHand,
            HumanBodyBones.RightShoulder, HumanBodyBones.RightUpperArm, HumanBodyBones.RightLowerArm, HumanBodyBones.RightHand,
        };

        /// <summary>The transforms whose positions are pushed, in the order of the stream's joints.</summary>
        Transform[] parts;
        MotionIndex opened;
        MotionStream stream;
        Action<MorecEvent> said;

        /// <summary>What is wrong with the stream, a sentence a line; empty if nothing is.</summary>
        public string Diagnosis { get { return stream == null ? "" : stream.Diagnosis(); } }

        void OnEnable()
        {
            if (index == null)
            {
                Debug.LogError("Morec Recognizer: no index is given.", this);
                enabled = false;
                return;
            }
            var options = new StreamOptions
            {
                leftHanded = true, sensitivity = sensitivity, performer = performer, tentative = tentative,
                eachRepetition = eachRepetition, deviation = deviation, progress = progress, refractorySecs = refractorySecs,
            };
            try
            {
                opened = new MotionIndex(index.bytes);
                stream = hands.Length == 0
                    ? new MotionStream(opened, options, FindParts())
                    : StreamOfHands(options);
                said = Say;
            }
            catch (MorecException error)
            {
                Debug.LogError("Morec Recognizer: " + error.Message, this);
                enabled = false;
            }
        }

        void OnDisable()
        {
            if (stream != null) stream.Dispose();
            if (opened != null) opened.Dispose();
            stream = null;
            opened = null;
        }

        /// <summary>Finds the transforms. Returns bit `r` for each role `r` with a transform.</summary>
        uint FindParts()
        {
            var humanoid = animator != null ? animator : GetComponent<Animator>();
            parts = new Transform[MotionStream.Roles];
            uint roles = 0;
            for (var role = 0; role < parts.Length; role++)
            {
                var bone = joints.Length == 0 && humanoid != null ? humanoid.GetBoneTransform(Bones[role]) : null;
                parts[role] = role < joints.Length ? joints[role] : bone;
                if (parts[role] != null) roles |= 1u << role;
            }
            return roles;
        }

        /// <summary>All transforms of the hands are joints: their names say which points they are.</summary>
        MotionStream StreamOfHands(StreamOptions options)
        {
            var found = new List<Transform>();
            foreach (var hand in hands)
                if (hand != null) found.AddRange(hand.GetComponentsInChildren<Transform>(true));
            parts = found.ToArray();
            var names = Array.ConvertAll(parts, part => part.name);
            // Points of hands have no parents: a tree would be a body's.
            return new MotionStream(opened, options, names, Array.ConvertAll(parts, part => -1));
        }

        /// <summary>Runs after animation and tracking have moved the joints.</summary>
        void LateUpdate()
        {
            if (stream == null) return;
            for (var role = 0; role < parts.Length; role++)
            {
                var at = parts[role] != null ? parts[role].position : new Vector3(float.NaN, float.NaN, float.NaN);
                stream.positions[3 * role] = at.x;
                stream.positions[3 * role + 1] = at.y;
                stream.positions[3 * role + 2] = at.z;
            }
            stream.Push(Time.timeAsDouble, said);
        }

        void Say(MorecEvent e)
        {
            var motion = new RecognisedMotion
            {
                name = opened.ClassName(e.class_id), number = e.motion, score = e.score, progress = e.progress,
                startSecs = e.start_secs, stopSecs = e.stop_secs, reportedSecs = e.reported_secs, wallSecs = e.wall_secs,
                sequence = e.sequence, repetitions = e.repetitions, periodSecs = e.period_secs,
                offDegrees = e.off_degrees, pace = e.pace, worstBone = e.worst_bone, worstDegrees = e.worst_degrees,
            };
            switch ((MorecPhase)e.phase)
            {
                case MorecPhase.Start: onStart.Invoke(motion); break;
                case MorecPhase.Update: onUpdate.Invoke(motion); break;
                case MorecPhase.Cancel: onCancel.Invoke(motion); break;
                case MorecPhase.Repetition: onRepetition.Invoke(motion); break;
                case MorecPhase.Progress: onProgress.Invoke(motion); break;
                case MorecPhase.End: onEnd.Invoke(motion); break;
            }
        }
    }
}
#endif
