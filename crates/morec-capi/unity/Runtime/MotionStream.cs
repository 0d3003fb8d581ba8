using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using System.Text;

namespace Morec
{
    /// <summary>The expected performer: decided automatically, the training subject, or anyone.</summary>
    public enum Performer { Auto, Teacher, Anyone }

    /// <summary>Options of a stream.</summary>
    public struct StreamOptions
    {
        /// <summary>True for left-handed axes like Unity's; false for right-handed axes.</summary>
        public bool leftHanded;
        /// <summary>Accepted false alarms a minute in background motion: 0.1 is strict, 1 is generous; 0: as trained.</summary>
        public double sensitivity;
        public Performer performer;
        /// <summary>Also what seems to be under way: starts, updates and cancellations.</summary>
        public bool tentative;
        /// <summary>Report each repetition of an activity as an event of its own.</summary>
        public bool eachRepetition;
        /// <summary>Say how far from the nearest sample each gesture that ends, and each such repetition, was.</summary>
        public bool deviation;
        /// <summary>Say with each frame how far every class has come.</summary>
        public bool progress;
        /// <summary>A motion of the same class that ends less than this after the one before it is not reported, seconds.</summary>
        public double refractorySecs;

        internal uint Flags
        {
            get
            {
                var flags = (tentative ? Native.MOREC_TENTATIVE : 0) | (eachRepetition ? Native.MOREC_EACH_REPETITION : 0)
                    | (deviation ? Native.MOREC_DEVIATION : 0) | (progress ? Native.MOREC_PROGRESS : 0);
                if (performer == Performer.Anyone) flags |= Native.MOREC_PERFORMER_ANYONE;
                if (performer == Performer.Teacher) flags |= Native.MOREC_PERFORMER_TEACHER;
                return (uint)flags;
            }
        }

        internal MorecOptions Given(uint roles, IntPtr skeleton)
        {
            return new MorecOptions
            {
                struct_size = Native.SizeOf<MorecOptions>(),
                handedness = (int)(leftHanded ? MorecHandedness.Left : MorecHandedness.Right),
                skeleton = skeleton,
                roles = roles,
                flags = Flags,
                sensitivity = sensitivity,
                refractory_secs = refractorySecs,
            };
        }
    }

    /// <summary>Recognises one performer's motions live. Y is up; lengths may have any unit.</summary>
    public sealed class MotionStream : IDisposable
    {
        /// <summary>Number of body parts, numbered as in MorecRole.</summary>
        public const int Roles = Native.MOREC_ROLE_COUNT;

        /// <summary>x, y, z of each role, or of each joint by its name; NaN if it is missing. Fill this in before calling Push.</summary>
        public readonly double[] positions;

        IntPtr handle;
        GCHandle pinned;
        MorecFrame frame;
        readonly MorecEvent[] events = new MorecEvent[32];

        /// <summary>A stream of the roles whose bit is set in `roles`; 0 for all.</summary>
        public MotionStream(MotionIndex index, StreamOptions options, uint roles)
            : this(Roles)
        {
            var given = options.Given(roles, IntPtr.Zero);
            MorecException.Check(Native.morec_recognizer_create(index.Handle, ref given, out handle));
            Pin();
        }

        /// <summary>A stream of joints with these names, from which the library finds what part of a body or which point of a hand each
        /// is (`LeftForearm`, `L_IndexTip`). `parents` has the number of each joint's parent, which comes before it, or -1.</summary>
        public MotionStream(MotionIndex index, StreamOptions options, string[] names, int[] parents)
            : this(names.Length)
        {
            if (parents.Length != names.Length)
                throw new ArgumentException(names.Length + " names of joints and " + parents.Length + " parents");
            using (var memory = new Unmanaged())
            {
                var skeleton = new MorecSkeleton
                {
                    struct_size = Native.SizeOf<MorecSkeleton>(),
                    joint_count = (UIntPtr)names.Length,
                    parents = memory.Pinned(parents),
                    names = memory.Pinned(Array.ConvertAll(names, name => memory.Pinned(Encoding.UTF8.GetBytes(name + "\0")))),
                };
                var given = options.Given(0, memory.Pinned(skeleton));
                MorecException.Check(Native.morec_recognizer_create(index.Handle, ref given, out handle));
            }
            Pin();
        }

        MotionStream(int joints)
        {
            positions = new double[3 * joints];
        }

        void Pin()
        {
            pinned = GCHandle.Alloc(positions, GCHandleType.Pinned);
            frame = new MorecFrame
            {
                struct_size = Native.SizeOf<MorecFrame>(),
                joint_count = (UIntPtr)(positions.Length / 3),
                positions = pinned.AddrOfPinnedObject(),
                space = (int)MorecSpace.World,
            };
        }

        /// <summary>What the library may read during a call.</summary>
        sealed class Unmanaged : IDisposable
        {
            readonly List<GCHandle> handles = new List<GCHandle>();

            public IntPtr Pinned(object value)
            {
                handles.Add(GCHandle.Alloc(value, GCHandleType.Pinned));
                return handles[handles.Count - 1].AddrOfPinnedObject();
            }

            public void Dispose()
            {
                foreach (var value in handles) value.Free();
            }
        }

        /// <summary>Processes the pose in `positions` and passes each event that it causes to `said`. Allocates no
        /// memory.</summary>
        public void Push(double timeSecs, Action<MorecEvent> said)
        {
            frame.time_secs = timeSecs;
            MorecException.Check(Native.morec_recognizer_push(handle, ref frame));
            Poll(said);
        }

        /// <summary>Ends the stream and passes on its last events. The next pose starts a new stream.</summary>
        public void Finish(Action<MorecEvent> said)
        {
            MorecException.Check(Native.morec_recognizer_finish(handle));
            Poll(said);
        }

        void Poll(Action<MorecEvent> said)
        {
            UIntPtr count;
            do
            {
                var capacity = (UIntPtr)events.Length;
                MorecException.Check(Native.morec_recognizer_poll(handle, events, Native.SizeOf<MorecEvent>(), capacity, out count));
                for (var i = 0; i < (int)count; i++) said(events[i]);
            } while ((int)count == events.Length);
        }

        /// <summary>What is wrong with the stream, a sentence a line with what to do; empty if nothing is.</summary>
        public string Diagnosis()
        {
            UIntPtr needed;
            Native.morec_recognizer_diagnosis_text(handle, null, UIntPtr.Zero, out needed);
            var bytes = new byte[(int)needed + 1024];
            MorecException.Check(Native.morec_recognizer_diagnosis_text(handle, bytes, (UIntPtr)bytes.Length, out needed));
            return Encoding.UTF8.GetString(bytes, 0, (int)needed - 1);
        }

        public void Dispose()
        {
            if (handle == IntPtr.Zero) return;
            Native.morec_recognizer_destroy(handle);
            handle = IntPtr.Zero;
            pinned.Free();
        }
    }
}
