#if !UNITY_5_3_OR_NEWER
using System;
using System.Globalization;
using System.IO;
using System.Runtime.InteropServices;
using Morec;

/// <summary>What `examples/stream.c` does, without Unity: poses as lines of text in, a line for each motion out.</summary>
static class StreamProgram
{
    static int Main(string[] arguments)
    {
        try
        {
            using (var index = new MotionIndex(File.ReadAllBytes(arguments[0])))
            using (var stream = Opened(index, arguments))
            {
                var mirrored = Array.IndexOf(arguments, "mirrored") > 0;
                Run(index, stream, mirrored ? -1 : 1);
                if (mirrored) Console.Error.WriteLine(stream.Diagnosis());
            }
            return 0;
        }
        catch (MorecException error)
        {
            Console.Error.WriteLine(error.Status + ": " + error.Message);
            return 1;
        }
    }

    static MotionStream Opened(MotionIndex index, string[] arguments)
    {
        var options = new StreamOptions { leftHanded = Array.IndexOf(arguments, "mirrored") > 0 };
        if (Array.IndexOf(arguments, "named") < 0) return new MotionStream(index, options, 0);
        var names = new string[MotionStream.Roles];
        var parents = Array.ConvertAll(names, name => -1);
        for (var role = 0; role < names.Length; role++) names[role] = Marshal.PtrToStringAnsi(Native.morec_role_name(role));
        return new MotionStream(index, options, names, parents);
    }

    /// <summary>`side` is the sign of x: a left-handed world is the mirrored one.</summary>
    static void Run(MotionIndex index, MotionStream stream, int side)
    {
        Action<MorecEvent> say = e => Console.WriteLine(string.Format(
            CultureInfo.InvariantCulture, "{0} {1:0.0000} {2:0.0000} {3:0.0000}", index.ClassName(e.class_id), e.start_secs, e.stop_secs, e.score));
        string line;
        while ((line = Console.ReadLine()) != null)
        {
            var words = line.Split(' ');
            for (var i = 0; i < stream.positions.Length; i++)
                stream.positions[i] = (i % 3 == 0 ? side : 1) * double.Parse(words[i + 1], CultureInfo.InvariantCulture);
            stream.Push(double.Parse(words[0], CultureInfo.InvariantCulture), say);
        }
        stream.Finish(say);
    }
}
#endif
