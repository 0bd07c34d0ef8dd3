MODULE PickPlace
    CONST robtarget pPick:=[[600,100.5,500],[0.0,0.0,1.0,0.0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST robtarget pPlace:=[[600,100.5,500],[0.0,0.0,1.0,0.0],[0,0,-1,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
    CONST jointtarget jReady:=[[10,-20,30,0,45,5],[9E9,9E9,9E9,9E9,9E9,9E9]];
    PERS tooldata tGripper:=[TRUE,[[0,0,120],[1,0,0,0]],[1.5,[0,0,60],[1,0,0,0],0,0,0]];
    VAR num nCount:=0;

    PROC main()
        MoveAbsJ jReady\NoEOffs,v1000,z50,tGripper;
        WHILE nCount<10 DO
            MoveJ Offs(pPick,0,0,100),v1000,z10,tGripper;
            MoveL pPick,v100,fine,tGripper;
            SetDO doGrip,1;
            WaitTime 0.3;
            MoveL RelTool(pPick,0,0,-100),v500,z10,tGripper;
            MoveL pPlace,v100,fine,tGripper\WObj:=wobj0;
            Incr nCount;
        ENDWHILE
    ENDPROC
ENDMODULE
